// SPDX-License-Identifier: MIT
#include "tools/camway/replay/compare/report_page.h"

#include <fmt/format.h>

#include <utility>

#include "tools/camway/replay/compare/reviews.h"

namespace camway::tools {
namespace {

/// Bytes of an image in a page for each byte of it, as base64 and with its heading.
constexpr double kPictureBytes = 1.4;

/// Room for the sentences on what is left out.
constexpr std::size_t kOmissionBytes = 2000;

std::size_t room_left(std::size_t most_bytes, std::size_t bytes) {
  return most_bytes > bytes ? most_bytes - bytes : 0;
}

/// Returns the size of the page without pictures and reviews, but with the buttons of all requests.
std::size_t bare_bytes(const ReportHead& head, const std::vector<ComparedRequest>& compared,
                       PageParts parts) {
  for (std::size_t i = 0; i < compared.size(); ++i) parts.reviews.insert(i);
  return html_report(head, compared, parts).size();
}

/// Adds the sentences on requests that are not shown in 3D.
void add_omissions(const ShelvedReviews& reviews, const PageOptions& options,
                   std::vector<std::string>& omissions) {
  if (!reviews.why_none.empty()) omissions.push_back(reviews.why_none);
  if (reviews.too_large > 0) {
    omissions.push_back(
        fmt::format("{} of {} requests are not shown in 3D: the page would have more than {} MB "
                    "(--most-mb)",
                    reviews.too_large, reviews.wanted, options.most_bytes / kMegabyte));
  }
  if (reviews.failed > 0) {
    omissions.push_back(fmt::format("{} of {} requests cannot be shown in 3D: {}", reviews.failed,
                                    reviews.wanted, reviews.first_failure));
  }
}

}  // namespace

ReportPage report_page(const ReportHead& head, const std::vector<ComparedRequest>& compared,
                       const SceneOf& scene_of, const PageOptions& options,
                       const view::PageFiles& page) {
  PageParts parts;
  parts.script = page.report_script;
  parts.policy = page.report_policy;
  const std::size_t most_bytes =
      room_left(options.most_bytes, bare_bytes(head, compared, parts) + kOmissionBytes);
  const ShelvedReviews reviews =
      reviews_of(compared, scene_of, head, {options.reviewed, most_bytes, page});
  parts.reviews = reviews.shown;
  parts.review_elements = reviews.elements;
  ReportPage result;
  add_omissions(reviews, options, result.omissions);
  const auto room = static_cast<double>(room_left(most_bytes, reviews.elements.size()));
  Pictures pictures = pictures_of(
      compared, scene_of, head, {options.pictures, static_cast<std::size_t>(room / kPictureBytes)});
  if (pictures.is_cut) {
    result.omissions.push_back(fmt::format(
        "there are no floor plans beyond the first {}: the page would have more than {} MB "
        "(--most-mb)",
        pictures.list.size(), options.most_bytes / kMegabyte));
  }
  parts.pictures = std::move(pictures.list);
  parts.notes = result.omissions;
  result.html = html_report(head, compared, parts);
  return result;
}

}  // namespace camway::tools
