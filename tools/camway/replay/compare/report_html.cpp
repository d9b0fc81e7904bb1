// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "daemon/base/base64.h"
#include "tools/camway/replay/compare/plots.h"
#include "tools/camway/replay/compare/report.h"

namespace camway::tools {
namespace {

/// The policy forbids every request of the page; images are data of the page itself.
constexpr char kHead[] = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:">
<meta name="viewport" content="width=device-width, initial-scale=1">
)";

/// The colours are those of the drawings (tools/drawing/palette.h).
constexpr char kStyle[] = R"(<style>
body { font: 14px/1.4 system-ui, sans-serif; color: #212121; margin: 24px; max-width: 1500px; }
h1 { font-size: 22px; } h2 { font-size: 17px; margin-top: 28px; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
th, td { padding: 3px 6px; border-bottom: 1px solid #dadada; text-align: left; vertical-align: top; }
th { cursor: pointer; background: #f2f1ed; }
td.number { text-align: right; } td:last-child { min-width: 15em; }
.verdict { font-weight: 600; white-space: nowrap; }
.chip { display: inline-block; padding: 2px 10px; margin-right: 6px; border: 1px solid #b3b0ab; border-radius: 10px; }
.plot { margin: 0 14px 10px 0; font-size: 11px; } .plot .grid { stroke: #dadada; } .plot .equal { stroke: #6b6b6b; stroke-dasharray: 4 3; }
svg circle { fill-opacity: 0.75; stroke: #ffffff; stroke-width: 0.5; }
.v-same { color: #6b6b6b; fill: #6b6b6b; } .v-not_compared { color: #b3b0ab; fill: #b3b0ab; }
.v-better { color: #009e73; fill: #009e73; } .v-different { color: #0072b2; fill: #0072b2; }
.v-worse { color: #a86f00; fill: #e69f00; } .v-regressed { color: #d55e00; fill: #d55e00; }
figure { margin: 8px 0 24px; } figure img { max-width: 100%; border: 1px solid #dadada; }
</style>
)";

/// Sorts the table by the column of a clicked head: by numbers where cells have them.
constexpr char kScript[] = R"(<script>
for (const head of document.querySelectorAll('th')) {
  head.addEventListener('click', () => {
    const body = document.querySelector('tbody');
    const column = head.cellIndex;
    const up = head.dataset.up !== 'yes';
    for (const other of document.querySelectorAll('th')) delete other.dataset.up;
    if (up) head.dataset.up = 'yes';
    const key = (row) => {
      const cell = row.cells[column];
      return 'v' in cell.dataset ? Number(cell.dataset.v) : cell.textContent;
    };
    const compare = (a, b) => {
      const x = key(a), y = key(b);
      return typeof x === 'number' && typeof y === 'number' ? x - y : String(x).localeCompare(String(y));
    };
    const rows = [...body.rows].sort((a, b) => (up ? compare(a, b) : compare(b, a)));
    body.append(...rows);
  });
}
</script>
)";

std::string cell(const std::string& text) { return "<td>" + in_html(text) + "</td>"; }

std::string shown(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : "-";
}

/// A cell is sorted by the change of its quantity, or by the quantity if that has one value.
std::string number_cell(const std::string& text, double sorted_by) {
  constexpr double kBeyondAll = 1e300;
  const double key = std::isfinite(sorted_by) ? sorted_by : kBeyondAll;
  return fmt::format(R"(<td class="number" data-v="{}">{}</td>)", key, in_html(text));
}
std::string number_cell(const std::optional<double>& value) {
  return number_cell(shown(value), value.value_or(-1.0));
}
std::string number_cell(const ThenAndNow& values) {
  const std::string then = shown(values.then);
  const std::string now = shown(values.now);
  const double change = values.then && values.now ? *values.now - *values.then : 0.0;
  return number_cell(then == now ? now : then + " → " + now, change);
}

std::string table_row(std::size_t index, const Row& row, Times times) {
  const std::string verdict(base::name_of(row.verdict));
  const std::string status =
      row.status_then == row.status_now ? row.status_now : row.status_then + " → " + row.status_now;
  std::string out = "<tr>" + number_cell(fmt::format("{}", index), static_cast<double>(index)) +
                    cell(row.client) + cell(fmt::format("{}", row.request)) + cell(row.scene) +
                    fmt::format(R"(<td class="verdict v-{0}">{0}</td>)", verdict) + cell(status) +
                    number_cell(row.path_m) + number_cell(row.shift_deg) +
                    number_cell(row.clearance_m) + number_cell(row.length_m) +
                    number_cell(row.deviation_m) + number_cell(row.inserted);
  if (times == Times::kShown) out += number_cell(row.total_ms);
  return out + cell(row.explanation) + "</tr>\n";
}

std::string table_of(const std::vector<Row>& rows, Times times) {
  std::string out = "<table>\n<thead><tr>";
  for (const char* name :
       {"#", "client", "request", "scene", "verdict", "status", "distance (m)", "shift (°)",
        "clearance (m)", "length (m)", "deviation (m)", "inserted"}) {
    out += fmt::format("<th>{}</th>", name);
  }
  if (times == Times::kShown) out += "<th>time (ms)</th>";
  out += "<th>reason</th></tr></thead>\n<tbody>\n";
  for (std::size_t i = 0; i < rows.size(); ++i) out += table_row(i, rows[i], times);
  return out + "</tbody>\n</table>\n";
}

std::string label_of(const Row& row) {
  return fmt::format("{} {}: {}", row.client, row.request, base::name_of(row.verdict));
}

std::string then_now(const std::string& title, const std::vector<Row>& rows,
                     ThenAndNow Row::*member) {
  std::vector<PlotMark> marks;
  for (const Row& row : rows) {
    const ThenAndNow& values = row.*member;
    if (values.then && values.now) {
      marks.push_back({*values.then, *values.now, row.verdict, label_of(row)});
    }
  }
  return then_now_plot(title, marks);
}

std::string by_request(const std::string& title, const std::vector<Row>& rows,
                       std::optional<double> Row::*member) {
  std::vector<PlotMark> marks;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (const auto& value = rows[i].*member) {
      marks.push_back({static_cast<double>(i), *value, rows[i].verdict, label_of(rows[i])});
    }
  }
  return by_request_plot(title, marks);
}

std::string plots_of(const ReportHead& head, const std::vector<Row>& rows) {
  const std::string pair = fmt::format(", {} against {}", head.now, head.then);
  std::string out = by_request("Distance of the paths (m), by request", rows, &Row::path_m) +
                    by_request("Shift of the picture (°), by request", rows, &Row::shift_deg) +
                    then_now("Proved clearance (m)" + pair, rows, &Row::clearance_m) +
                    then_now("Length (m)" + pair, rows, &Row::length_m) +
                    then_now("Deviation (m)" + pair, rows, &Row::deviation_m);
  if (head.times == Times::kShown) out += then_now("Time (ms)" + pair, rows, &Row::total_ms);
  return out;
}

std::string figure_of(const RequestPicture& picture, const Row& row) {
  return fmt::format(
      "<h2 id=\"r{}\">#{} {} {}</h2>\n<p><span class=\"verdict v-{}\">{}</span> {}</p>\n"
      "<figure><img alt=\"floor plan of both paths\" "
      "src=\"data:image/svg+xml;base64,{}\"></figure>\n",
      picture.index, picture.index, in_html(row.client), row.request, base::name_of(row.verdict),
      base::name_of(row.verdict), in_html(row.explanation), base::encode_base64(picture.svg));
}

std::string chips_of(const std::vector<ComparedRequest>& compared) {
  std::string out = "<p>";
  for (const auto& [name, verdict] : base::named_values<Verdict>()) {
    out +=
        fmt::format(R"(<span class="chip v-{0}">{1} {0}</span>)", name, count(compared, verdict));
  }
  return out + "</p>\n";
}

}  // namespace

std::string html_report(const ReportHead& head, const std::vector<ComparedRequest>& compared,
                        const std::vector<RequestPicture>& pictures) {
  std::vector<Row> rows;
  for (const ComparedRequest& each : compared) rows.push_back(row_of(each));
  std::string out = std::string(kHead) + "<title>" + in_html(head.title) + "</title>\n" + kStyle +
                    "</head>\n<body>\n<h1>" + in_html(head.title) + "</h1>\n<p>" +
                    in_html(summary_line(compared)) + "</p>\n" + chips_of(compared);
  for (const std::string& note : head.notes) out += "<p>Note: " + in_html(note) + "</p>\n";
  out += "<div>" + plots_of(head, rows) + "</div>\n" + table_of(rows, head.times);
  for (const RequestPicture& picture : pictures) {
    out += figure_of(picture, rows[picture.index]);
  }
  return out + kScript + "</body>\n</html>\n";
}

}  // namespace camway::tools
