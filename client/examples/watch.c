/* SPDX-License-Identifier: MIT */
/* Has a daemon watch a path while a box is pushed into its way and pulled out again. The program takes the events on
   its own thread, as an engine does once a frame.
   cc watch.c $(pkg-config --cflags --libs camway-c) -o watch && ./watch office */
#include <camway/camway.h>
#include <stdio.h>

static const double LONGEST_WAIT_S = 30.0;

/* The newest path that is proved free, which the camera of an engine would follow. */
struct follower {
  camway_answer *answer;
  int num_answers;
  int has_ended;
};

static void take(struct follower *follower, const camway_watch_event *event) {
  if (event->kind == CAMWAY_EVENT_ANSWER && event->answer != NULL) {
    camway_answer_free(follower->answer);
    follower->answer = NULL;
    camway_answer_copy(event->answer, &follower->answer);
    ++follower->num_answers;
    printf("answer %d: %s\n", follower->num_answers, camway_answer_message(event->answer));
  } else if (event->kind == CAMWAY_EVENT_BROKEN && event->num_broken > 0) {
    printf("broken from %.2f s on\n", event->broken[0].t_begin_s);
  } else if (event->kind == CAMWAY_EVENT_ENDED || event->kind == CAMWAY_EVENT_LOST) {
    follower->has_ended = 1;
    printf("no longer watched: %s\n", event->error);
  }
}

/* Takes events until there were that many answers. Returns whether they came. An engine has 0.0 in place of
   LONGEST_WAIT_S, and takes what is there. */
static int wait_for_answers(struct follower *follower, camway_event_queue *queue, int count) {
  camway_watch_event event;
  while (!follower->has_ended && follower->num_answers < count &&
         camway_event_queue_next(queue, LONGEST_WAIT_S, &event, sizeof event) == CAMWAY_OK) {
    take(follower, &event);
  }
  return follower->num_answers >= count;
}

static int run(camway_client *client, const char *scene, camway_event_queue *queue,
               struct follower *follower) {
  const camway_keyframe keyframes[] = {{0.0, {12.5, 1.6, 12.8}, {0.374, 0.0, -0.928, 0.0}},
                                       {5.0, {17.5, 1.6, 17.9}, {0.378, 0.0, -0.926, 0.0}}};
  const double size_m[3] = {0.2, 2.0, 0.2};
  const camway_pose place = {{13.75, 1.0, 14.1}, {1.0, 0.0, 0.0, 0.0}};
  camway_plan_request request;
  int64_t watch = 0;
  camway_plan_request_init(&request, sizeof request);
  request.scene = scene;
  request.keyframes = keyframes;
  request.num_keyframes = sizeof keyframes / sizeof keyframes[0];

  if (camway_watch_start_polled(client, &request, queue, &watch) != CAMWAY_OK) return 1;
  if (!wait_for_answers(follower, queue, 1)) return 1;
  if (camway_scene_put_box(client, scene, "post", size_m, &place, NULL) != CAMWAY_OK) return 1;
  if (!wait_for_answers(follower, queue, 2)) return 1;
  if (camway_scene_remove(client, scene, "post", NULL) != CAMWAY_OK) return 1;
  return camway_watch_end(client, watch, LONGEST_WAIT_S) == CAMWAY_OK ? 0 : 1;
}

int main(int argc, char **argv) {
  struct follower follower = {NULL, 0, 0};
  camway_client *client = NULL;
  camway_event_queue *queue = NULL;
  int result = 1;
  if (camway_client_create(NULL, &client) == CAMWAY_OK &&
      camway_event_queue_create(&queue) == CAMWAY_OK) {
    result = run(client, argc > 1 ? argv[1] : "office", queue, &follower);
  }
  if (result != 0) fprintf(stderr, "failed: %s\n", camway_last_error());
  camway_client_free(client);
  camway_event_queue_free(queue);
  camway_answer_free(follower.answer);
  return result;
}
