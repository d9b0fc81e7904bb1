// SPDX-License-Identifier: MIT
#include <camway/camway.h>
#include <camway/client.h>

#include <algorithm>

#include "client/c/handles.h"
#include "client/c/scene_calls.h"
#include "client/c/scene_shapes.h"
#include "client/c/sized.h"

namespace camway::c {
namespace {

camway_scene_info info_of(const SceneInfo& from) {
  camway_scene_info info{};
  info.name = from.name.c_str();
  info.digest = from.digest.c_str();
  info.revision = from.revision;
  info.num_triangles = from.num_triangles;
  std::copy_n(from.bounds_min_m.begin(), 3, info.bounds_min_m);
  std::copy_n(from.bounds_max_m.begin(), 3, info.bounds_max_m);
  info.occupancy_resolution_m = from.occupancy_resolution_m;
  return info;
}

camway_object_info info_of(const SceneObject& from) {
  camway_object_info info{};
  info.name = from.name.c_str();
  info.kind = from.kind.c_str();
  info.digest = from.digest.c_str();
  info.num_triangles = from.num_triangles;
  std::copy_n(from.pose.position_m.begin(), 3, info.pose.position_m);
  std::copy_n(from.pose.orientation_wxyz.begin(), 4, info.pose.orientation_wxyz);
  std::copy_n(from.bounds_min_m.begin(), 3, info.bounds_min_m);
  std::copy_n(from.bounds_max_m.begin(), 3, info.bounds_max_m);
  return info;
}

}  // namespace
}  // namespace camway::c

using namespace camway::c;

camway_status camway_scene_answer_free(camway_scene_answer* answer) {
  return guarded([&] {
    Handles::all().take(answer);
    return CAMWAY_OK;
  });
}

camway_status camway_scene_answer_scene(const camway_scene_answer* answer, camway_scene_info* scene,
                                        size_t struct_size) {
  return guarded([&] {
    write_sized(info_of(Handles::all().find(answer)->scene), scene, struct_size);
    return CAMWAY_OK;
  });
}

const char* camway_scene_answer_message(const camway_scene_answer* answer) {
  return guarded_text([&] { return Handles::all().find(answer)->message.c_str(); });
}

camway_status camway_scene_answer_num_scenes(const camway_scene_answer* answer, size_t* count) {
  return guarded([&] { return write_count(Handles::all().find(answer)->scenes.size(), count); });
}

camway_status camway_scene_answer_scene_at(const camway_scene_answer* answer, size_t index,
                                           camway_scene_info* scene, size_t struct_size) {
  return guarded([&] {
    write_sized(info_of(item_of(Handles::all().find(answer)->scenes, index)), scene, struct_size);
    return CAMWAY_OK;
  });
}

camway_status camway_scene_answer_num_objects(const camway_scene_answer* answer, size_t* count) {
  return guarded([&] { return write_count(Handles::all().find(answer)->objects.size(), count); });
}

camway_status camway_scene_answer_object_at(const camway_scene_answer* answer, size_t index,
                                            camway_object_info* object, size_t struct_size) {
  return guarded([&] {
    write_sized(info_of(item_of(Handles::all().find(answer)->objects, index)), object, struct_size);
    return CAMWAY_OK;
  });
}

camway_status camway_mesh_file_init(camway_mesh_file* mesh, size_t struct_size) {
  return guarded([&] {
    init_sized(default_mesh_file(), mesh, struct_size);
    return CAMWAY_OK;
  });
}

camway_status camway_scene_list(camway_client* client, camway_scene_answer** answer) {
  return ask_about_scenes(client, answer,
                          [](camway::Client& found) { return found.list_scenes(); });
}

camway_status camway_scene_describe(camway_client* client, const char* scene,
                                    camway_scene_answer** answer) {
  return ask_about_scenes(client, answer, [&](camway::Client& found) {
    return found.describe_scene(text_of(scene, "scene"));
  });
}

camway_status camway_scene_load(camway_client* client, const char* scene,
                                const camway_mesh_file* mesh, double occupancy_resolution_m,
                                camway_scene_answer** answer) {
  return ask_about_scenes(client, answer, [&](camway::Client& found) {
    return found.load_scene(text_of(scene, "scene"),
                            mesh == nullptr ? camway::SceneMesh{} : mesh_of(mesh),
                            occupancy_resolution_m);
  });
}

camway_status camway_scene_unload(camway_client* client, const char* scene,
                                  camway_scene_answer** answer) {
  return ask_about_scenes(client, answer, [&](camway::Client& found) {
    return found.unload_scene(text_of(scene, "scene"));
  });
}

camway_status camway_scene_put_box(camway_client* client, const char* scene, const char* object,
                                   const double size_m[3], const camway_pose* pose,
                                   camway_scene_answer** answer) {
  const auto shape = [&] {
    require(size_m, "size_m");
    return camway::SceneBox{{size_m[0], size_m[1], size_m[2]}};
  };
  return put(client, scene, object, shape, pose, answer);
}

camway_status camway_scene_put_sphere(camway_client* client, const char* scene, const char* object,
                                      double radius_m, const camway_pose* pose,
                                      camway_scene_answer** answer) {
  const auto shape = [&] { return camway::SceneSphere{radius_m, 0.0}; };
  return put(client, scene, object, shape, pose, answer);
}

camway_status camway_scene_put_cylinder(camway_client* client, const char* scene,
                                        const char* object, double radius_m, double height_m,
                                        const camway_pose* pose, camway_scene_answer** answer) {
  const auto shape = [&] { return camway::SceneCylinder{radius_m, height_m, 0.0}; };
  return put(client, scene, object, shape, pose, answer);
}

camway_status camway_scene_put_file(camway_client* client, const char* scene, const char* object,
                                    const camway_mesh_file* mesh, const camway_pose* pose,
                                    camway_scene_answer** answer) {
  const auto shape = [&] { return mesh_of(mesh); };
  return put(client, scene, object, shape, pose, answer);
}

camway_status camway_scene_put_triangles(camway_client* client, const char* scene,
                                         const char* object, const double* vertices_m,
                                         size_t num_vertices, const uint32_t* triangles,
                                         size_t num_triangles, const camway_pose* pose,
                                         camway_scene_answer** answer) {
  const auto shape = [&] { return ply_of(vertices_m, num_vertices, triangles, num_triangles); };
  return put(client, scene, object, shape, pose, answer);
}

camway_status camway_scene_move(camway_client* client, const char* scene, const char* object,
                                const camway_pose* pose, camway_scene_answer** answer) {
  return ask_about_scenes(client, answer, [&](camway::Client& found) {
    return found.move_object(text_of(scene, "scene"), text_of(object, "object"), pose_of(pose));
  });
}

camway_status camway_scene_remove(camway_client* client, const char* scene, const char* object,
                                  camway_scene_answer** answer) {
  return ask_about_scenes(client, answer, [&](camway::Client& found) {
    return found.remove_object(text_of(scene, "scene"), text_of(object, "object"));
  });
}

camway_status camway_scene_cancel_calls(camway_client* client) {
  return guarded([&] {
    Handles::all().find(client)->cancel_scene_calls();
    return CAMWAY_OK;
  });
}
