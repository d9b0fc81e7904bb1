// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "daemon/base/base64.h"
#include "tools/camway/replay/compare/plots.h"
#include "tools/camway/replay/compare/report.h"

namespace camway::tools {
namespace {

/// The policy of a page without a script; images are data of the page itself.
constexpr char kPlainPolicy[] = "default-src 'none'; style-src 'unsafe-inline'; img-src data:";

/// The colours are those of the drawings (tools/drawing/palette.h), and lighter on a dark ground.
constexpr char kStyle[] = R"(<style>
:root { color-scheme: light dark; --ground: #ffffff; --text: #212121; --muted: #6b6b6b; --line: #dadada; --head: #f2f1ed; --frame: #b3b0ab;
  --same: #6b6b6b; --better: #00795a; --different: #0072b2; --worse: #8f5f00; --regressed: #b84300; --accent: #0b5cad; }
@media (prefers-color-scheme: dark) { :root { --ground: #121416; --text: #e8eaec; --muted: #a0a8af; --line: #363b40; --head: #23272b; --frame: #5b6268;
  --same: #a0a8af; --better: #5ccfa4; --different: #6db6f2; --worse: #e9b44c; --regressed: #ff9457; --accent: #6db6f2; } }
body { font: 14px/1.4 system-ui, sans-serif; color: var(--text); background: var(--ground); margin: 24px; max-width: 1500px; }
h1 { font-size: 22px; } h2 { font-size: 17px; margin-top: 28px; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
th, td { padding: 3px 6px; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top; }
th { background: var(--head); } th[data-sorts] { cursor: pointer; }
td.number { text-align: right; } td:last-child { min-width: 15em; overflow-wrap: anywhere; } td.views { white-space: nowrap; }
button { font: inherit; padding: 0 8px; color: var(--text); background: var(--head); border: 1px solid var(--frame); border-radius: 4px; cursor: pointer; }
button:disabled { opacity: 0.45; cursor: default; } a { color: var(--accent); }
.verdict { font-weight: 600; white-space: nowrap; }
.chip { display: inline-block; padding: 2px 10px; margin-right: 6px; border: 1px solid var(--frame); border-radius: 10px; }
.plot { margin: 0 14px 10px 0; font-size: 11px; } .plot text { fill: var(--text); } .plot .grid { stroke: var(--line); } .plot .equal { stroke: var(--muted); stroke-dasharray: 4 3; }
svg circle { fill-opacity: 0.75; stroke: var(--ground); stroke-width: 0.5; }
.v-same { color: var(--same); fill: var(--same); } .v-not_compared { color: var(--frame); fill: var(--frame); }
.v-better { color: var(--better); fill: var(--better); } .v-different { color: var(--different); fill: var(--different); }
.v-worse { color: var(--worse); fill: var(--worse); } .v-regressed { color: var(--regressed); fill: var(--regressed); }
figure { margin: 8px 0 24px; } figure img { max-width: 100%; border: 1px solid var(--line); }
dialog.viewer { position: fixed; inset: 0; width: 100vw; height: 100vh; max-width: none; max-height: none; margin: 0; padding: 0; border: 0; color: var(--text); background: var(--ground); overflow: hidden; }
dialog.viewer[open] { display: flex; flex-direction: column; }
dialog.viewer header { display: flex; gap: 10px; align-items: center; padding: 6px 14px; border-bottom: 1px solid var(--line); }
dialog.viewer .reason { flex: 1; min-width: 0; overflow: hidden; white-space: nowrap; text-overflow: ellipsis; color: var(--muted); }
dialog.viewer iframe { flex: 1; width: 100%; border: 0; }
@media print { button, dialog { display: none !important; } figure { break-inside: avoid; } }
</style>
)";

std::string head_of(const std::string& title, const PageParts& parts) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n{}</head>\n",
      parts.policy.empty() ? kPlainPolicy : parts.policy, in_html(title), kStyle);
}

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

std::string title_of(std::size_t index, const Row& row) {
  return fmt::format("#{} {} {}", index, in_html(row.client), row.request);
}

std::string review_button(std::size_t index) {
  return fmt::format(R"(<button type="button" data-review="{}">3D</button>)", index);
}

/// The requests that have pictures, and those that can be shown in 3D.
struct Shown {
  std::set<std::size_t> pictures, reviews;
};

/// Returns the cell with what shows a request: a button, and a link to the floor plan.
std::string views_cell(std::size_t index, const Shown& shown) {
  std::string out = "<td class=\"views\">";
  if (shown.reviews.contains(index)) out += review_button(index);
  if (shown.pictures.contains(index)) out += fmt::format(" <a href=\"#r{}\">plan</a>", index);
  return out + "</td>";
}

std::string table_row(std::size_t index, const Row& row, const Shown& shown, Times times) {
  const std::string verdict(base::name_of(row.verdict));
  const std::string status =
      row.status_then == row.status_now ? row.status_now : row.status_then + " → " + row.status_now;
  std::string out =
      fmt::format("<tr data-title=\"{}, {}\">", title_of(index, row), verdict) +
      number_cell(fmt::format("{}", index), static_cast<double>(index)) + views_cell(index, shown) +
      cell(row.client) + cell(fmt::format("{}", row.request)) + cell(row.scene) +
      fmt::format(R"(<td class="verdict v-{0}">{0}</td>)", verdict) + cell(status) +
      number_cell(row.path_m) + number_cell(row.shift_deg) + number_cell(row.clearance_m) +
      number_cell(row.length_m) + number_cell(row.deviation_m) + number_cell(row.mean_shift_deg) +
      number_cell(row.inserted);
  if (times == Times::kShown) out += number_cell(row.total_ms);
  return out + cell(row.explanation) + "</tr>\n";
}

std::string table_of(const std::vector<Row>& rows, const Shown& shown, const ReportHead& head) {
  const Times times = head.times;
  std::string out = "<table>\n<thead><tr>";
  for (const char* name :
       {"#", "view", "client", "request", "scene", "verdict", "status", "distance (m)", "shift (°)",
        "clearance (m)", "length (m)", "deviation (m)", "mean shift (°)", "inserted"}) {
    out += fmt::format("<th>{}</th>", name);
  }
  if (times == Times::kShown) out += "<th>time (ms)</th>";
  out += "<th>reason</th></tr></thead>\n<tbody>\n";
  for (std::size_t i = 0; i < rows.size(); ++i) out += table_row(i, rows[i], shown, times);
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
  std::string out =
      by_request("Distance of the paths (m), by request", rows, &Row::path_m) +
      by_request("Shift of the picture (°), by request", rows, &Row::shift_deg) +
      then_now("Proved clearance (m)" + pair, rows, &Row::clearance_m) +
      then_now("Length (m)" + pair, rows, &Row::length_m) +
      then_now("Deviation (m)" + pair, rows, &Row::deviation_m) +
      then_now("Mean shift from the path as interpolated (°)" + pair, rows, &Row::mean_shift_deg);
  if (head.times == Times::kShown) out += then_now("Time (ms)" + pair, rows, &Row::total_ms);
  return out;
}

std::string figure_of(const RequestPicture& picture, const Row& row, const Shown& shown) {
  const std::size_t index = picture.index;
  return fmt::format(
      "<h2 id=\"r{}\">{} {}</h2>\n<p><span class=\"verdict v-{}\">{}</span> {}</p>\n"
      "<figure><img alt=\"floor plan of both paths\" "
      "src=\"data:image/svg+xml;base64,{}\"></figure>\n",
      index, title_of(index, row), shown.reviews.contains(index) ? review_button(index) : "",
      base::name_of(row.verdict), base::name_of(row.verdict), in_html(row.explanation),
      base::encode_base64(picture.svg));
}

/// Returns the sentences on how the page shows requests.
std::string words_on_views(const ReportHead& head, const PageParts& parts) {
  if (parts.reviews.empty()) return {};
  return fmt::format(
      "<p>3D shows a request in its scene, with both paths: {} and {}. Scenes are simplified for "
      "the picture where they are large; the bar at its foot says so.</p>\n"
      "<p id=\"no-webgl\" hidden>This browser has no WebGL 2, so there are floor plans alone."
      "</p>\n<noscript><p>Without JavaScript there are floor plans alone.</p></noscript>\n",
      in_html(head.then), in_html(head.now));
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
                        const PageParts& parts) {
  std::vector<Row> rows;
  for (const ComparedRequest& each : compared) rows.push_back(row_of(each));
  Shown shown{{}, parts.reviews};
  for (const RequestPicture& picture : parts.pictures) shown.pictures.insert(picture.index);
  std::string out = head_of(head.title, parts) + "<body>\n<h1>" + in_html(head.title) +
                    "</h1>\n<p>" + in_html(summary_line(compared)) + "</p>\n" + chips_of(compared);
  for (const std::vector<std::string>& notes : {all_notes(head, compared), parts.notes}) {
    for (const std::string& note : notes) out += "<p>Note: " + in_html(note) + "</p>\n";
  }
  out += words_on_views(head, parts) + "<div>" + plots_of(head, rows) + "</div>\n" +
         table_of(rows, shown, head);
  for (const RequestPicture& picture : parts.pictures) {
    out += figure_of(picture, rows[picture.index], shown);
  }
  out += parts.review_elements;
  if (!parts.script.empty()) out += fmt::format("<script>{}</script>\n", parts.script);
  return out + "</body>\n</html>\n";
}

}  // namespace camway::tools
