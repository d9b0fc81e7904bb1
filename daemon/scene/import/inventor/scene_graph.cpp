// SPDX-License-Identifier: MIT
#include "daemon/scene/import/inventor/scene_graph.h"

#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/VRMLnodes/SoVRMLInline.h>
#include <Inventor/VRMLnodes/SoVRMLLOD.h>
#include <Inventor/misc/SoChildList.h>
#include <Inventor/nodes/SoFile.h>
#include <Inventor/nodes/SoLOD.h>
#include <Inventor/nodes/SoLevelOfDetail.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoUnits.h>
#include <Inventor/nodes/SoWWWInline.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <unordered_set>
#include <utility>

#include "daemon/gzip/inflate.h"
#include "daemon/scene/import/common/included_files.h"
#include "daemon/scene/import/inventor/coin_library.h"

namespace camway::scene::inventor {
namespace {

using Fault = std::string;  ///< empty if there is none

/// Coin knows an EXTERNPROTO only by the file that it names, and no file is fetched for it.
Fault with_advice(const std::string& error) {
  if (error.find("EXTERNPROTO") == Fault::npos) return error;
  return error +
         ": prototypes of other files are not read; write their nodes into this file, or "
         "export glTF";
}

/// Types whose nodes are no geometry and change none, but which a user may look for.
constexpr std::array kIgnoredTypes = {"Light",
                                      "Camera",
                                      "Texture",
                                      "Texture2",
                                      "Texture3",
                                      "VRMLTexture",
                                      "VRMLSensor",
                                      "VRMLTimeSensor",
                                      "VRMLTouchSensor",
                                      "VRMLDragSensor",
                                      "VRMLProximitySensor",
                                      "VRMLVisibilitySensor",
                                      "VRMLScript",
                                      "VRMLInterpolator",
                                      "VRMLSound",
                                      "VRMLAudioClip",
                                      "VRMLViewpoint",
                                      "VRMLBackground",
                                      "VRMLFog",
                                      "VRMLLight",
                                      "VRMLNavigationInfo",
                                      "ClipPlane",
                                      "Callback",
                                      "EventCallback",
                                      "Environment",
                                      "ShaderProgram",
                                      "Dragger",
                                      "BumpMap"};

/// Coin's input, which opens the files of `File` nodes only below the folder of the scene.
class FolderInput : public SoInput {
 public:
  /// `here`: the folder of the file that is read.
  FolderInput(const std::string& folder, std::filesystem::path here, std::uint64_t& files)
      : folder_(folder), here_(std::move(here)), files_(files) {}

  SbBool pushFile(const char* name) override {
    const base::Result<std::filesystem::path> path = path_below(folder_, folder_of_top() / name);
    const std::string text = "inline file '" + std::string(name) + "' ";
    if (!path) return refuse(text + path.error);
    if (std::ranges::count(open_, path->string()) > 0) return refuse(text + "includes itself");
    if (open_.size() >= kMostInlineDepth || ++files_ > kMostInlineFiles) {
      return refuse(text + "is one too many");
    }
    open_.push_back(path->string());
    return SoInput::pushFile(path->c_str());
  }

  [[nodiscard]] const Fault& fault() const { return fault_; }

 protected:
  SbBool popFile() override {
    if (!open_.empty()) open_.pop_back();
    return SoInput::popFile();
  }

 private:
  [[nodiscard]] std::filesystem::path folder_of_top() const {
    return open_.empty() ? here_ : std::filesystem::path(open_.back()).parent_path();
  }

  SbBool refuse(Fault fault) {
    if (fault_.empty()) fault_ = std::move(fault);
    return FALSE;
  }

  const std::string& folder_;
  const std::filesystem::path here_;
  std::uint64_t& files_;
  std::vector<std::string> open_;
  Fault fault_;
};

/// The name of a local file that an inline node asks for; empty if it asks for none.
std::string local_name(std::string url) {
  constexpr std::string_view kFile = "file:";
  if (url.starts_with(kFile)) {
    url.erase(0, kFile.size());
    if (url.starts_with("//")) url.erase(0, 2);
  }
  return url.find("://") == std::string::npos ? url : "";
}

/// Reads a file and those that it includes, and looks at each node once.
class GraphReader {
 public:
  explicit GraphReader(const SceneFolder& folder) : folder_(folder) {
    for (const char* const name : kIgnoredTypes) {
      const SoType type = SoType::fromName(name);
      if (type != SoType::badType()) ignored_.push_back(type);
    }
  }

  Fault read(std::string_view bytes) { return read_file(bytes, "", graph_.root); }
  SceneGraph take() { return std::move(graph_); }

 private:
  Fault read_file(std::string_view bytes, const std::string& name, SoSeparator*& root) {
    namespace fs = std::filesystem;
    SoInput::clearDirectories();
    const fs::path here = (fs::path(folder_.folder) / name).parent_path();
    SoInput::addDirectoryFirst(name.empty() ? folder_.folder.c_str() : here.c_str());
    FolderInput input(folder_.folder, name.empty() ? fs::path(folder_.folder) : here,
                      graph_.inline_files);
    input.setBuffer(bytes.data(), bytes.size());
    root = SoDB::readAll(&input);
    if (root != nullptr) root->ref();
    if (!input.fault().empty()) return input.fault();
    CoinMessages messages = take_messages();
    if (!messages.errors.empty()) return with_advice(messages.errors.front());
    if (root == nullptr) return "is no Open Inventor or VRML file";
    for (std::string& warning : messages.warnings) graph_.warnings.push_back(std::move(warning));
    if (name.empty()) note_format(input);
    return visit(*root, name);
  }

  void note_format(SoInput& input) {
    const bool is_vrml1 = input.isFileVRML1() == TRUE;
    const bool is_vrml2 = input.isFileVRML2() == TRUE;
    graph_.is_vrml = is_vrml1 || is_vrml2;
    graph_.format = is_vrml1 ? "VRML 1.0" : is_vrml2 ? "VRML 97" : "Open Inventor";
    if (input.isBinary() == TRUE) graph_.format += ", binary";
  }

  /// Visits the nodes below `root`, which come from file `name`.
  Fault visit(SoNode& root, const std::string& name) {
    std::vector<SoNode*> open = {&root};
    while (!open.empty()) {
      SoNode& node = *open.back();
      open.pop_back();
      if (!visited_.insert(&node).second) continue;
      ++graph_.nodes;
      if (Fault fault = visit_node(node, name); !fault.empty()) return fault;
      const SoChildList* const children = node.getChildren();
      for (int i = 0; children != nullptr && i < children->getLength(); ++i) {
        if ((*children)[i] != nullptr) open.push_back((*children)[i]);
      }
    }
    return {};
  }

  Fault visit_node(SoNode& node, const std::string& name) {
    const auto is_kind = [&](SoType type) { return node.isOfType(type); };
    if (std::ranges::any_of(ignored_, is_kind)) {
      ++graph_.ignored[node.getTypeId().getName().getString()];
    }
    graph_.has_units = graph_.has_units || node.isOfType(SoUnits::getClassTypeId());
    if (node.isOfType(SoLOD::getClassTypeId())) {
      auto& lod = static_cast<SoLOD&>(node);
      lod.range.setNum(0);
      keep_finest(lod);
    } else if (node.isOfType(SoLevelOfDetail::getClassTypeId())) {
      keep_finest(static_cast<SoLevelOfDetail&>(node));
    } else if (node.isOfType(SoVRMLLOD::getClassTypeId())) {
      auto& lod = static_cast<SoVRMLLOD&>(node);
      lod.range.setNum(0);
      keep_finest(lod);
    } else if (node.isOfType(SoWWWInline::getClassTypeId())) {
      auto& inlined = static_cast<SoWWWInline&>(node);
      if (inlined.name.isDefault() == TRUE) return {};  // asks for nothing
      return fill(inlined, {inlined.name.getValue().getString()}, name);
    } else if (node.isOfType(SoVRMLInline::getClassTypeId())) {
      auto& inlined = static_cast<SoVRMLInline&>(node);
      if (inlined.url.getNum() == 0) return {};
      std::vector<std::string> urls;
      for (int i = 0; i < inlined.url.getNum(); ++i) urls.emplace_back(inlined.url[i].getString());
      return fill(inlined, urls, name);
    }
    return {};
  }

  /// The first child is the finest.
  void keep_finest(SoGroup& group) {
    while (group.getNumChildren() > 1) {
      group.removeChild(group.getNumChildren() - 1);
      ++graph_.coarse_levels;
    }
  }

  template <class Inline>
  Fault fill(Inline& node, const std::vector<std::string>& urls, const std::string& from) {
    const auto local =
        std::ranges::find_if(urls, [](const std::string& url) { return !local_name(url).empty(); });
    if (local == urls.end()) {
      graph_.not_fetched.push_back(urls.front().empty() ? "no name" : urls.front());
      return {};
    }
    const std::string text = "inline file '" + *local + "'";
    base::Result<IncludedFile> file = folder_.open(from, local_name(*local));
    if (!file) return text + " " + file.error;
    if (std::ranges::count(stack_, file->name) > 0) return text + " includes itself";
    if (stack_.size() >= kMostInlineDepth || ++graph_.inline_files > kMostInlineFiles) {
      return text + " is one too many";
    }
    if (gzip::is_gzip(file->text)) {
      base::Result<std::string> plain = gzip::inflated(file->text);
      if (!plain) return text + " " + plain.error;
      file->text = *std::move(plain);
    }
    stack_.push_back(file->name);
    SoSeparator* content = nullptr;
    Fault fault = read_file(file->text, file->name, content);
    stack_.pop_back();
    if (!fault.empty()) return text + ": " + fault;
    node.setChildData(content);
    return {};
  }

  const SceneFolder& folder_;
  SceneGraph graph_;
  std::vector<SoType> ignored_;
  std::unordered_set<const SoNode*> visited_;
  std::vector<std::string> stack_;  ///< inline files that are being read
};

}  // namespace

base::Result<SceneGraph> read_scene_graph(std::string_view bytes, const SceneFolder& folder) {
  GraphReader reader(folder);
  if (Fault fault = reader.read(bytes); !fault.empty()) return base::Failure{std::move(fault)};
  return reader.take();
}

}  // namespace camway::scene::inventor
