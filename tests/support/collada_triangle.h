// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace camway::testing {

inline constexpr std::string_view kColladaMetre = R"(<unit name="meter" meter="1"/>)";
inline constexpr std::string_view kColladaNode =
    R"(<node id="n" name="n"><instance_geometry url="#g"/></node>)";

/// Returns a COLLADA document, y up, with a triangle of the geometry "g". `positions`: nine
/// numbers; `nodes`: those of its scene.
inline std::string collada_triangle(std::string_view positions,
                                    std::string_view unit = kColladaMetre,
                                    std::string_view nodes = kColladaNode) {
  std::string text = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
 <asset>)";
  text.append(unit).append(R"(<up_axis>Y_UP</up_axis></asset>
 <library_geometries><geometry id="g" name="g"><mesh>
  <source id="p"><float_array id="a" count="9">)");
  text.append(positions).append(R"(</float_array>
   <technique_common><accessor source="#a" count="3" stride="3">
    <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
   </accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  <triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
 </mesh></geometry></library_geometries>
 <library_visual_scenes><visual_scene id="s">)");
  text.append(nodes).append(R"(</visual_scene></library_visual_scenes>
 <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>)");
  return text;
}

}  // namespace camway::testing
