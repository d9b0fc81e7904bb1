// SPDX-License-Identifier: MIT
#pragma once

#include <string>

/// A COLLADA file with an animated camera.
namespace camway::testing {

/// A camera of 60 degrees across, 2 units in front of an arm that is 10 units up. The camera goes
/// from there to 4 units in front in 2 s, and turns by 90 degrees to its left. A unit is half a
/// metre. `target` is that of the animation.
inline std::string collada_camera(const std::string& target) {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="0.5"/><up_axis>Y_UP</up_axis></asset>
<library_cameras><camera id="lens" name="lens"><optics><technique_common><perspective>
<xfov>60</xfov><aspect_ratio>1.5</aspect_ratio><znear>0.2</znear><zfar>100</zfar>
</perspective></technique_common></optics></camera></library_cameras>
<library_animations><animation id="a">
<source id="t"><float_array id="ta" count="2">0 2</float_array><technique_common>
<accessor source="#ta" count="2" stride="1"><param name="TIME" type="float"/></accessor>
</technique_common></source>
<source id="m"><float_array id="ma" count="32"> 1 0 0 0 0 1 0 0 0 0 1 -2 0 0 0 1
 0 0 1 0 0 1 0 0 -1 0 0 -4 0 0 0 1</float_array><technique_common>
<accessor source="#ma" count="2" stride="16"><param name="TRANSFORM" type="float4x4"/></accessor>
</technique_common></source>
<source id="i"><Name_array id="ia" count="2">LINEAR LINEAR</Name_array><technique_common>
<accessor source="#ia" count="2" stride="1"><param name="INTERPOLATION" type="name"/></accessor>
</technique_common></source>
<sampler id="s"><input semantic="INPUT" source="#t"/><input semantic="OUTPUT" source="#m"/>
<input semantic="INTERPOLATION" source="#i"/></sampler>
<channel source="#s" target=")" +
         target + R"("/></animation></library_animations>
<library_visual_scenes><visual_scene id="v">
<node id="arm" name="arm"><translate>0 10 0</translate>
<node id="eye" name="eye"><matrix sid="transform"> 1 0 0 0 0 1 0 0 0 0 1 -2 0 0 0 1</matrix>
<instance_camera url="#lens"/></node></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#v"/></scene></COLLADA>)";
}

}  // namespace camway::testing
