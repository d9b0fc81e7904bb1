// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "tools/view/backend.h"

/// The first page. All of it is here, so that another page can take its place.
namespace camway::view {

/// Returns `text` for HTML, where it is text and nothing else.
std::string as_html(std::string_view text);

/// Returns the page about the last plan, which may be null. Names from files are text in it.
std::string first_page(const std::string& scene, const LastPlan* last);
std::string_view page_style();

/// Returns the floor plan of the last plan as SVG, without walls if its triangles are not known.
std::string plan_picture(const LastPlan& last);

}  // namespace camway::view
