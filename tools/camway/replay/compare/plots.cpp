// SPDX-License-Identifier: MIT
#include "tools/camway/replay/compare/plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "lcmtypes/wire/channels.h"

namespace camway::tools {
namespace {

constexpr double kWidth_px = 340.0;
constexpr double kHeight_px = 260.0;
constexpr double kLeft_px = 58.0;
constexpr double kTop_px = 28.0;
constexpr double kRight_px = 12.0;
constexpr double kBottom_px = 34.0;
constexpr double kMark_px = 4.0;
/// Decades of a logarithmic axis, at most.
constexpr double kMostDecades = 12.0;

/// Maps values to a length in pixels, of which `at` is the begin.
struct PlotAxis {
  double least = 0.0;
  double most = 1.0;
  double begin_px = 0.0;
  double end_px = 1.0;

  [[nodiscard]] double px(double value) const {
    const double share = (value - least) / (most - least);
    return begin_px + (share > 0.0 ? std::min(share, 1.0) : 0.0) * (end_px - begin_px);
  }
};

PlotAxis x_axis(double least, double most) {
  return {least, most, kLeft_px, kWidth_px - kRight_px};
}
PlotAxis y_axis(double least, double most) {
  return {least, most, kHeight_px - kBottom_px, kTop_px};
}

/// Returns 1, 2 or 5 times a power of ten, so that about four steps fill `range`. Requires 0 <
/// range.
double step_of(double range) {
  constexpr double kSteps = 4.0;
  const double power = std::pow(10.0, std::floor(std::log10(range / kSteps)));
  const double digits = range / kSteps / power;
  return power * (digits < 2.0 ? 1.0 : digits < 5.0 ? 2.0 : 5.0);
}

std::string line(double x0, double y0, double x1, double y1, std::string_view kind) {
  return fmt::format(R"(<line class="{}" x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)", kind,
                     x0, y0, x1, y1);
}

std::string words(double x, double y, std::string_view anchor, const std::string& text) {
  return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}">{}</text>)", x, y, anchor,
                     in_html(text));
}

std::string tick_x(const PlotAxis& x, double value, const std::string& text) {
  return line(x.px(value), kTop_px, x.px(value), kHeight_px - kBottom_px, "grid") +
         words(x.px(value), kHeight_px - kBottom_px + 15, "middle", text);
}
std::string tick_y(const PlotAxis& y, double value, const std::string& text) {
  return line(kLeft_px, y.px(value), kWidth_px - kRight_px, y.px(value), "grid") +
         words(kLeft_px - 5, y.px(value) + 4, "end", text);
}

std::string mark_at(const PlotMark& mark, double x_px, double y_px) {
  return fmt::format(
      R"(<circle class="v-{}" cx="{:.1f}" cy="{:.1f}" r="{}"><title>{}</title></circle>)",
      base::name_of(mark.verdict), x_px, y_px, kMark_px, in_html(mark.label));
}

std::string plot(const std::string& title, const std::string& content) {
  return fmt::format(
      R"(<svg class="plot" role="img" viewBox="0 0 {0} {1}" width="{0}" height="{1}">)"
      "{2}{3}</svg>\n",
      kWidth_px, kHeight_px, words(kLeft_px, kTop_px - 12, "start", title), content);
}

/// Sorts the marks by verdict, the worst last, since marks that are drawn last are seen best.
std::vector<PlotMark> worst_last(std::vector<PlotMark> marks) {
  std::ranges::stable_sort(marks, std::ranges::less(), &PlotMark::verdict);
  return marks;
}

}  // namespace

std::string in_html(const std::string& text) {
  std::string out;
  for (const char c : wire::printable(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string then_now_plot(const std::string& title, const std::vector<PlotMark>& marks) {
  std::vector<PlotMark> shown = marks;
  std::erase_if(
      shown, [](const PlotMark& mark) { return !std::isfinite(mark.x) || !std::isfinite(mark.y); });
  if (shown.empty()) return {};
  double most = 0.0;
  for (const PlotMark& mark : shown) most = std::max({most, mark.x, mark.y});
  if (!(most > 0.0)) most = 1.0;
  const PlotAxis x = x_axis(0.0, most);
  const PlotAxis y = y_axis(0.0, most);
  std::string content;
  for (double tick = 0.0; tick <= most; tick += step_of(most)) {
    content += tick_x(x, tick, fmt::format("{:g}", tick));
    content += tick_y(y, tick, fmt::format("{:g}", tick));
  }
  content += line(x.px(0.0), y.px(0.0), x.px(most), y.px(most), "equal");
  for (const PlotMark& mark : worst_last(shown))
    content += mark_at(mark, x.px(mark.x), y.px(mark.y));
  return plot(title, content);
}

std::string by_request_plot(const std::string& title, const std::vector<PlotMark>& marks) {
  if (marks.empty()) return {};
  double low = 0.0;
  double high = -kMostDecades;
  for (const PlotMark& mark : marks) {
    if (!(mark.y > 0.0) || !std::isfinite(mark.y)) continue;
    low = std::min(low, std::log10(mark.y));
    high = std::max(high, std::log10(mark.y));
  }
  high = std::max(std::ceil(high), 0.0);
  low = std::max(std::floor(low), high - kMostDecades) - 1.0;
  const PlotAxis x = x_axis(0.0, static_cast<double>(marks.size()));
  const PlotAxis y = y_axis(low, high + 1.0);
  std::string content = tick_y(y, low, "0") + tick_y(y, high + 1.0, "none");
  const double step = std::max(1.0, std::ceil((high - low) / 5.0));
  for (double decade = high; decade > low; decade -= step) {
    content += tick_y(y, decade, fmt::format("{:g}", std::pow(10.0, decade)));
  }
  for (const PlotMark& mark : worst_last(marks)) {
    const double height = mark.y > 0.0 ? std::log10(mark.y) : low;
    content += mark_at(mark, x.px(mark.x + 0.5), y.px(height));
  }
  return plot(title, content);
}

}  // namespace camway::tools
