/* SPDX-License-Identifier: MIT */
/* Has a daemon watch a path while a box is pushed into its way and pulled out again. Handlers run on a thread
   of the client, so this one only keeps what came; an engine would look at it once a frame.
   cc watch.c $(pkg-config --cflags --libs camway-c) -pthread -o watch && ./watch office */
#define _POSIX_C_SOURCE 200809L
#include <camway/camway.h>
#include <pthread.h>
#include <stdio.h>
#include <time.h>

enum { LONGEST_WAIT_S = 30 };

/* The newest path that is proved free, which the camera of an engine would follow. */
struct follower {
  pthread_mutex_t mutex;
  pthread_cond_t changed;
  camway_answer *answer;
  int num_answers;
  int num_broken;
  int has_ended;
};

static void on_event(void *user, const camway_watch_event *event) {
  struct follower *follower = (struct follower *)user;
  pthread_mutex_lock(&follower->mutex);
  if (event->kind == CAMWAY_EVENT_ANSWER && event->answer != NULL) {
    camway_answer_free(follower->answer);
    follower->answer = NULL;
    camway_answer_copy(event->answer, &follower->answer);
    ++follower->num_answers;
    printf("answer %d: %s\n", follower->num_answers, camway_answer_message(event->answer));
  } else if (event->kind == CAMWAY_EVENT_BROKEN && event->num_broken > 0) {
    ++follower->num_broken;
    printf("broken from %.2f s on\n", event->broken[0].t_begin_s);
  } else if (event->kind == CAMWAY_EVENT_ENDED || event->kind == CAMWAY_EVENT_LOST) {
    follower->has_ended = 1;
    printf("no longer watched: %s\n", event->error);
  }
  pthread_cond_signal(&follower->changed);
  pthread_mutex_unlock(&follower->mutex);
}

/* Waits for that many answers. Returns whether they came. */
static int wait_for_answers(struct follower *follower, int count) {
  struct timespec until;
  int timed_out = 0, is_there;
  clock_gettime(CLOCK_REALTIME, &until);
  until.tv_sec += LONGEST_WAIT_S;
  pthread_mutex_lock(&follower->mutex);
  while (!timed_out && !follower->has_ended && follower->num_answers < count) {
    timed_out = pthread_cond_timedwait(&follower->changed, &follower->mutex, &until);
  }
  is_there = follower->num_answers >= count;
  pthread_mutex_unlock(&follower->mutex);
  return is_there;
}

static int run(camway_client *client, const char *scene, struct follower *follower) {
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

  if (camway_watch_start(client, &request, on_event, follower, &watch) != CAMWAY_OK) return 1;
  if (!wait_for_answers(follower, 1)) return 1;
  if (camway_scene_put_box(client, scene, "post", size_m, &place, NULL) != CAMWAY_OK) return 1;
  if (!wait_for_answers(follower, 2)) return 1;
  if (camway_scene_remove(client, scene, "post", NULL) != CAMWAY_OK) return 1;
  return camway_watch_end(client, watch, LONGEST_WAIT_S) == CAMWAY_OK ? 0 : 1;
}

int main(int argc, char **argv) {
  struct follower follower = {PTHREAD_MUTEX_INITIALIZER, PTHREAD_COND_INITIALIZER, NULL, 0, 0, 0};
  camway_client *client = NULL;
  int result = 1;
  if (camway_client_create(NULL, &client) == CAMWAY_OK) {
    result = run(client, argc > 1 ? argv[1] : "office", &follower);
  }
  if (result != 0) fprintf(stderr, "failed: %s\n", camway_last_error());
  camway_client_free(client);
  camway_answer_free(follower.answer);
  return result;
}
