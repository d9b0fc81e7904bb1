// SPDX-License-Identifier: MIT
#include "daemon/scene/import/inventor/coin_library.h"

#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/VRMLnodes/SoVRMLInline.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/errors/SoReadError.h>
#include <Inventor/fields/SoSFTime.h>
#include <Inventor/misc/SoProto.h>
#include <Inventor/nodekits/SoNodeKit.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoShape.h>
#include <Inventor/nodes/SoWWWInline.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace camway::scene::inventor {
namespace {

/// A hostile file can make Coin say a line for each of its bytes.
constexpr std::size_t kMostMessages = 20;

CoinMessages& messages() {
  static CoinMessages all;
  return all;
}

/// One line without Coin's own name: "Unknown field "x", occurred at line 3".
std::string tidied(std::string text) {
  for (const std::string_view prefix :
       {"Coin read error: ", "Coin warning in ", "Coin error in "}) {
    if (text.starts_with(prefix)) text.erase(0, prefix.size());
  }
  std::string line;
  bool is_space = false;
  for (const char c : text) {
    const bool separates = c == ' ' || c == '\n' || c == '\t' || c == '\r';
    if (!separates) {
      if (is_space && !line.empty()) line += ' ';
      line += c;
    }
    is_space = separates;
  }
  for (const auto& [from, to] :
       {std::pair<std::string_view, std::string_view>(" Occurred at line ", ", at line "),
        {" in <memory>", ""}}) {
    if (const std::size_t at = line.rfind(from); at != std::string::npos) {
      line.replace(at, from.size(), to);
    }
  }
  return line;
}

void keep(std::vector<std::string>& list, const SoError* error) {
  std::string line = tidied(error->getDebugString().getString());
  if (list.size() < kMostMessages && std::ranges::count(list, line) == 0) {
    list.push_back(std::move(line));
  }
}

void take_error(const SoError* error, void* /*unused*/) { keep(messages().errors, error); }
void take_warning(const SoError* error, void* /*unused*/) { keep(messages().warnings, error); }

SoProto* fetch_no_prototype(SoInput* /*unused*/, const SbString* /*unused*/, int /*unused*/,
                            void* /*unused*/) {
  return nullptr;
}

/// Coin opens standard input when it first reads, and its font when it first makes a text.
void read_once() {
  constexpr std::string_view kScene = "#Inventor V2.1 ascii\nText3 { string \"a\" parts ALL }\n";
  SoInput input;
  input.setBuffer(kScene.data(), kScene.size());
  SoSeparator* const scene = SoDB::readAll(&input);
  if (scene == nullptr) return;
  scene->ref();
  SoCallbackAction action;
  action.addTriangleCallback(
      SoShape::getClassTypeId(),
      [](void*, SoCallbackAction*, const SoPrimitiveVertex*, const SoPrimitiveVertex*,
         const SoPrimitiveVertex*) {},
      nullptr);
  action.apply(scene);
  scene->unref();
}

}  // namespace

void start_coin() {
  for (const char* const name : {"COIN_FORCE_FREETYPE_OFF", "COIN_FORCE_FONTCONFIG_OFF",
                                 "COIN_NO_SOTYPE_DYNLOAD", "COIN_SOUND_DISABLE"}) {
    setenv(name, "1", 1);  // NOLINT(concurrency-mt-unsafe): one thread
  }
  SoDB::init();
  SoNodeKit::init();
  SoInteraction::init();
  SoReadError::setHandlerCallback(take_error, nullptr);
  SoDebugError::setHandlerCallback(take_warning, nullptr);
  SoProto::setFetchExternProtoCallback(fetch_no_prototype, nullptr);
  SoWWWInline::setReadAsSoFile(FALSE);
  SoWWWInline::setBoundingBoxVisibility(SoWWWInline::NEVER);
  SoVRMLInline::setReadAsSoFile(FALSE);
  SoVRMLInline::setBoundingBoxVisibility(SoVRMLInline::NEVER);
  // Two reads must not differ by the clock. Rotors and engines that were tried do not move without
  // an event loop; this is for one that reads the clock directly.
  if (auto* const now = dynamic_cast<SoSFTime*>(SoDB::getGlobalField("realTime"))) {
    now->setValue(SbTime(0.0));
  }
  read_once();
  take_messages();
}

CoinMessages take_messages() { return std::exchange(messages(), {}); }

}  // namespace camway::scene::inventor
