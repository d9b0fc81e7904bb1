// SPDX-License-Identifier: MIT
#ifndef CAMWAY_C_EVENT_QUEUE_H
#define CAMWAY_C_EVENT_QUEUE_H

#include <camway/c/watch.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Events of watched paths, for a program that takes them on a thread of its own, for example once
/// a frame. One queue may be for all watches of a program, of any clients.
typedef struct camway_event_queue camway_event_queue;

camway_status camway_event_queue_create(camway_event_queue** queue);

/// Frees the queue with all that is in it. Its watches go on without anybody who takes their
/// events: end them before.
camway_status camway_event_queue_free(camway_event_queue* queue);

/// Does as `camway_watch_start`, with a queue in place of the handler. A request that cannot be
/// sent has no event: the status and `camway_last_error` say why.
camway_status camway_watch_start_polled(camway_client* client, const camway_plan_request* request,
                                        camway_event_queue* queue, int64_t* watch);

/// Takes the oldest event, and waits for one at most `timeout_s`; 0: does not wait.
/// CAMWAY_NOT_READY if there is none. The event, and all in it, is good until the next call for
/// this queue; `camway_answer_copy` keeps an answer. `struct_size` is `sizeof(camway_watch_event)`.
///
///     while (camway_event_queue_next(queue, 0.0, &event, sizeof event) == CAMWAY_OK) {...}
///
/// A queue keeps the newest 100 events of each watch. `camway_watch_event::num_missed` counts those
/// that it dropped before one.
camway_status camway_event_queue_next(camway_event_queue* queue, double timeout_s,
                                      camway_watch_event* event, size_t struct_size);

#ifdef __cplusplus
}
#endif

#endif
