/* SPDX-License-Identifier: MIT */
/* Plans a path through a scene of a daemon, puts a box in its way, plans again, and prints poses.
   cc plan.c $(pkg-config --cflags --libs camway-c) -o plan && ./plan office */
#include <camway/camway.h>
#include <stdio.h>

enum { NUM_POSES = 5 };

static int fail(const char *what) {
  fprintf(stderr, "%s: %s\n", what, camway_last_error());
  return 1;
}

/* Prints the path of an answer: what is proved of it, and some of its poses. */
static int print_path(const camway_answer *answer) {
  camway_answer_summary summary;
  double times_s[NUM_POSES], positions_m[NUM_POSES][3], orientations_wxyz[NUM_POSES][4];
  int i;
  if (camway_answer_summarize(answer, &summary, sizeof summary) != CAMWAY_OK) return fail("answer");
  printf("%s\n", camway_answer_message(answer));
  for (i = 0; i < NUM_POSES; ++i) {
    times_s[i] = summary.begin_s + (summary.end_s - summary.begin_s) * i / (NUM_POSES - 1);
  }
  if (camway_answer_poses(answer, times_s, NUM_POSES, positions_m[0], orientations_wxyz[0]) != CAMWAY_OK) {
    return fail("poses");
  }
  for (i = 0; i < NUM_POSES; ++i) {
    printf("  at %.2f s: %.3f %.3f %.3f\n", times_s[i], positions_m[i][0], positions_m[i][1], positions_m[i][2]);
  }
  return 0;
}

static int plan_and_print(camway_client *client, const camway_plan_request *request) {
  camway_answer *answer = NULL;
  const camway_status status = camway_plan(client, request, 30.0, &answer);
  const int result = status == CAMWAY_OK ? print_path(answer) : fail(camway_status_name(status));
  camway_answer_free(answer);
  return result;
}

static int run(camway_client *client, const char *scene) {
  const camway_keyframe keyframes[] = {{0.0, {12.5, 1.6, 12.8}, {0.374, 0.0, -0.928, 0.0}},
                                       {2.5, {15.0, 1.6, 15.4}, {0.376, 0.0, -0.927, 0.0}},
                                       {5.0, {17.5, 1.6, 17.9}, {0.378, 0.0, -0.926, 0.0}}};
  const double size_m[3] = {0.2, 2.0, 0.2};
  const camway_pose place = {{13.75, 1.0, 14.1}, {1.0, 0.0, 0.0, 0.0}};
  camway_plan_request request;
  int result;
  camway_plan_request_init(&request, sizeof request);
  request.scene = scene;
  request.keyframes = keyframes;
  request.num_keyframes = sizeof keyframes / sizeof keyframes[0];
  request.near_m = 0.15;

  result = plan_and_print(client, &request);
  if (result != 0) return result;
  if (camway_scene_put_box(client, scene, "post", size_m, &place, NULL) != CAMWAY_OK) return fail("put");
  result = plan_and_print(client, &request);
  if (camway_scene_remove(client, scene, "post", NULL) != CAMWAY_OK) return fail("remove");
  return result;
}

int main(int argc, char **argv) {
  camway_client *client = NULL;
  int result;
  printf("Camway %s, ABI %d\n", camway_version(), (int)camway_abi_version());
  if (camway_client_create(NULL, &client) != CAMWAY_OK) return fail("client");
  result = run(client, argc > 1 ? argv[1] : "office");
  camway_client_free(client);
  return result;
}
