// SPDX-License-Identifier: MIT
#ifndef CAMWAY_C_WATCH_H
#define CAMWAY_C_WATCH_H

#include <camway/c/answer.h>
#include <camway/c/client.h>
#include <camway/c/request.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
  CAMWAY_EVENT_ANSWER = 0,   ///< a new answer: the first, a corrected one, or one after a restart
  CAMWAY_EVENT_BROKEN = 1,   ///< a change of the scene makes the path collide where `broken` says
  CAMWAY_EVENT_FREE = 2,     ///< a broken path is proved free again, unchanged
  CAMWAY_EVENT_LOST = 3,     ///< the path is not watched for now; `status` and `error` say why
  CAMWAY_EVENT_WATCHED = 4,  ///< watched again; the last event before CAMWAY_EVENT_LOST still holds
  CAMWAY_EVENT_ENDED = 5,    ///< the watch has ended; `status` and `error` say why
  CAMWAY_EVENT_BETTER = 6,   ///< an obstacle is gone, and `answer` is a better path
  CAMWAY_EVENT_WITHDRAWN = 7,  ///< the better path is no longer offered
  CAMWAY_EVENT_RESTARTED = 8   ///< the daemon was started anew; the next event has the result
};

/// An event of a path that the daemon watches.
typedef struct camway_watch_event {
  uint32_t struct_size;  ///< bytes that the library has set
  int32_t kind;          ///< CAMWAY_EVENT_ANSWER, ...; pass over kinds that you do not know
  int64_t watch;         ///< the id from `camway_watch_start`
  int64_t scene_revision;
  camway_status status;  ///< CAMWAY_EVENT_LOST, CAMWAY_EVENT_ENDED: the reason; else CAMWAY_OK
  uint32_t num_broken;
  const char* error;               ///< the reason in words; else ""
  const camway_answer* answer;     ///< CAMWAY_EVENT_ANSWER, CAMWAY_EVENT_BETTER; else NULL
  const camway_collision* broken;  ///< CAMWAY_EVENT_BROKEN: all collisions, without witnesses
  int64_t num_missed;              ///< events of its watch before it that a queue dropped; else 0
} camway_watch_event;

/// Takes an event, unless the program polls (`camway/c/event_queue.h`). It runs on the client's
/// thread, so it must be quick and must not call functions that wait. The event, and all in it, is
/// good until it returns; `camway_answer_copy` keeps an answer.
typedef void (*camway_watch_handler)(void* user, const camway_watch_event* event);

/// Requests a path and has the daemon watch it until `camway_watch_end`. Handles lost messages and
/// restarts of the daemon. `user` must live until the client is freed.
camway_status camway_watch_start(camway_client* client, const camway_plan_request* request,
                                 camway_watch_handler handler, void* user, int64_t* watch);

/// Ends a watch, and waits at most `timeout_s` until the daemon has ended it; 0: does not wait, and
/// then an event may still come. CAMWAY_NOT_READY if the daemon did not confirm.
camway_status camway_watch_end(camway_client* client, int64_t watch, double timeout_s);

/// Has the daemon watch the better path that it offered last. CAMWAY_EVENT_ANSWER confirms it.
/// Handlers may call it.
camway_status camway_watch_take_better(camway_client* client, int64_t watch);

#ifdef __cplusplus
}
#endif

#endif
