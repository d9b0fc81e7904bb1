// SPDX-License-Identifier: MIT
#include "daemon/scene/import/content_kind.h"

#include <algorithm>
#include <array>
#include <span>

#include "daemon/scene/import/readers/tokens.h"

namespace camway::scene {
namespace {

/// A kind of content, known by its first bytes and, if that is not enough, a word after them.
struct Content {
  std::string_view first;
  std::string_view word;
  std::string_view name;
  /// Extensions that its files have; the first one is offered.
  std::array<std::string_view, 4> extensions;
};

constexpr std::array<Content, 13> kContents = {{
    {"#Inventor V", "", "Open Inventor", {".iv", ".wrl", "", ""}},
    {"#VRML V", "", "VRML", {".wrl", ".wrz", ".vrml", ".iv"}},
    {"ISO-10303-21;", "'IFC", "IFC", {".ifc", "", "", ""}},
    {"ISO-10303-21;", "", "STEP", {".step", ".stp", ".p21", ".ifc"}},
    {"Kaydara FBX Binary", "", "FBX", {".fbx", "", "", ""}},
    {"; FBX", "", "FBX", {".fbx", "", "", ""}},
    {"glTF", "", "binary glTF", {".glb", ".vrm", "", ""}},
    {"{", "\"asset\"", "glTF", {".gltf", ".json", "", ""}},
    {"<?xml", "<COLLADA", "COLLADA", {".dae", ".xml", "", ""}},
    {"BLENDER", "", "a file of Blender", {".blend", "", "", ""}},
    {"#usda", "", "USD", {".usda", ".usd", "", ""}},
    {"PXR-USDC", "", "USD", {".usdc", ".usd", "", ""}},
    {"# .PCD", "", "PCD", {".pcd", "", "", ""}},
}};

}  // namespace

std::string content_fault(std::string_view extension, std::string_view begin) {
  begin = mesh_readers::without_bom(begin);
  for (const Content& content : kContents) {
    if (!begin.starts_with(content.first)) continue;
    if (begin.find(content.word) == std::string_view::npos) continue;
    const bool fits = std::ranges::any_of(content.extensions, [&](std::string_view each) {
      return !each.empty() && mesh_readers::equals_ignoring_case(extension, each);
    });
    if (fits) return "";
    return "its content is " + std::string(content.name) + ": name it " +
           std::string(content.extensions[0]);
  }
  return "";
}

}  // namespace camway::scene
