// SPDX-License-Identifier: MIT
#ifndef CAMWAY_CAMWAY_H
#define CAMWAY_CAMWAY_H

/// The C interface of Camway's client: for engines, and for bindings of other languages. C11 and
/// C++.
///
/// - Handles (`camway_client *`, ...) are opaque, and are numbers rather than addresses: a handle
///   that was freed, or is of another kind, is refused with `CAMWAY_BAD_ARGUMENT`. Each is freed by
///   its `_free` function, which takes NULL as well.
/// - A struct that begins with `struct_size` may get more members at its end. Its `_init` function
///   sets that size and the defaults; every struct that goes in has to be initialised so. Other
///   structs never change.
/// - Texts are UTF-8 and end with a zero. Texts and arrays that go in are copied before a function
///   returns. Texts that come out belong to the handle that they came from, and live as long.
/// - Functions return a status, and write results through pointers. No exception leaves a function,
///   and `camway_last_error` has the text of a failure.
/// - All functions are thread-safe. Lengths are metres, times seconds, angles radians; quaternions
///   are w, x, y, z, camera to world. The camera looks down -Z, +Y is up, and the world is
///   right-handed.
///
/// docs/c.md has a program, docs/versions.md says what may change in which version.

#include <camway/c/answer.h>
#include <camway/c/base.h>
#include <camway/c/client.h>
#include <camway/c/event_queue.h>
#include <camway/c/frame.h>
#include <camway/c/measures.h>
#include <camway/c/occupancy.h>
#include <camway/c/plan.h>
#include <camway/c/proof.h>
#include <camway/c/request.h>
#include <camway/c/scan.h>
#include <camway/c/scene.h>
#include <camway/c/scene_history.h>
#include <camway/c/watch.h>

#endif
