// SPDX-License-Identifier: MIT
#ifndef CAMWAY_C_PLAN_H
#define CAMWAY_C_PLAN_H

#include <camway/c/answer.h>
#include <camway/c/client.h>
#include <camway/c/request.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Requests a path and waits for the answer, at most `timeout_s`; 0 or infinity: as long as the
/// call takes, which the client's `deadline_s` limits. Returns the status of the answer. `answer`
/// gets a handle whenever the request was well formed, also one without a path: free it. After
/// `timeout_s` the request is cancelled, `answer` is NULL, and the status CAMWAY_NOT_READY.
camway_status camway_plan(camway_client* client, const camway_plan_request* request,
                          double timeout_s, camway_answer** answer);

/// The progress of a request in the daemon.
typedef struct camway_progress {
  uint32_t struct_size;    ///< bytes that the library has set
  int32_t stage;           ///< CAMWAY_WAITING, ...
  int32_t requests_ahead;  ///< CAMWAY_WAITING: estimated number of requests that start earlier
  int32_t num_collisions;  ///< of the path as interpolated; 0 before CAMWAY_CORRECTING
  int32_t num_corrected;   ///< collisions that are corrected
  int32_t is_known;        ///< whether a report has come yet; if not, the other members are 0
  double since_receipt_s;  ///< time since the daemon received the request
  double deadline_s;       ///< deadline of the request, counted from its receipt
} camway_progress;
enum {
  CAMWAY_WAITING = 0,
  CAMWAY_PREPARING = 1,
  CAMWAY_DETECTING = 2,
  CAMWAY_CORRECTING = 3,
  CAMWAY_CERTIFYING = 4
};

/// Handlers of a pending request. They run on the client's thread, so they must be quick and must
/// not call functions that wait. Each may be NULL. Their arguments are valid until they return.
typedef struct camway_plan_handlers {
  uint32_t struct_size;
  uint32_t reserved;  ///< 0
  void* user;         ///< given to the handlers; must live until `on_answer` has run
  void (*on_progress)(void* user, const camway_progress* progress);
  /// Runs once for each request that was started, `camway_client_free` at the latest. For a request
  /// that cannot be sent it runs before `camway_plan_start` returns.
  void (*on_answer)(void* user, const camway_answer* answer);
} camway_plan_handlers;

/// Sets all members to NULL. `struct_size` is `sizeof(camway_plan_handlers)`.
camway_status camway_plan_handlers_init(camway_plan_handlers* handlers, size_t struct_size);

/// A request that was started.
typedef struct camway_pending camway_pending;

/// Requests a path and returns at once. NULL for `handlers` means none: poll. Handlers may call it.
camway_status camway_plan_start(camway_client* client, const camway_plan_request* request,
                                const camway_plan_handlers* handlers, camway_pending** pending);

/// Waits for the answer, at most `timeout_s`; 0: does not wait. CAMWAY_NOT_READY if it is not there
/// yet; otherwise its status, and each call gives a new handle of the answer. `answer` may be NULL.
camway_status camway_pending_wait(camway_pending* pending, double timeout_s,
                                  camway_answer** answer);

/// The last report of progress. `struct_size` is `sizeof(camway_progress)`.
camway_status camway_pending_progress(const camway_pending* pending, camway_progress* progress,
                                      size_t struct_size);

/// Cancels the request. Its answer comes soon: CAMWAY_CANCELLED, or the finished one.
camway_status camway_pending_cancel(camway_pending* pending);

/// Frees the handle; cancels the request if it has no answer yet, and `on_answer` still runs.
camway_status camway_pending_free(camway_pending* pending);

#ifdef __cplusplus
}
#endif

#endif
