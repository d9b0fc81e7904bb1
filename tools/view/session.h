// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "daemon/http/server.h"
#include "tools/view/desk.h"

namespace camway::view {

/// Returns the conversation over one WebSocket: numbered messages in, numbered answers out, in any
/// order.
///
/// The latest of plans with the same `drag` wins. One is under way and at most one waits; when a
/// newer one comes, the one under way is cancelled, and the one that waits is dropped. Both are
/// answered with `superseded`, even where the plan has ended meanwhile. One that may finish
/// (`Message::Plan::may_finish`) is not cancelled: where plans take longer than the time between
/// requests, there would be no answer before the end of the drag.
std::unique_ptr<http::SocketEvents> open_session(std::shared_ptr<Desk> desk,
                                                 std::shared_ptr<http::Socket> socket);

}  // namespace camway::view
