// SPDX-License-Identifier: MIT
#include <camway/client.h>
#include <pybind11/stl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "client/python/module/callback.h"
#include "client/python/module/exit_gate.h"
#include "client/python/module/interruption.h"
#include "client/python/module/lazy.h"
#include "client/python/module/module.h"

namespace camway::python {
namespace {

using std::chrono::steady_clock;

/// Time for which a call that took too long waits for the end of its cancelled request.
constexpr std::chrono::milliseconds kCancelGrace{500};

/// Wait for a heartbeat where the caller names none.
constexpr double kStatusTimeout_s = 3.0;

steady_clock::time_point after(double seconds) {
  constexpr double kLongest_s = 3600.0 * 24 * 365;
  const std::chrono::duration<double> time(std::clamp(seconds, 0.0, kLongest_s));
  return steady_clock::now() + std::chrono::duration_cast<steady_clock::duration>(time);
}

/// Returns a time to wait. Throws ConversionFault for NaN, which no time comes after.
std::optional<double> timeout_of(py::handle value) {
  const auto timeout_s = argument<std::optional<double>>(value, "timeout_s");
  if (timeout_s && std::isnan(*timeout_s)) {
    throw ConversionFault(ConversionFault::Kind::kValue, "must be seconds, not NaN")
        .within("timeout_s");
  }
  return timeout_s;
}

/// Returns the options of a client from keyword arguments, which the package has checked.
ClientOptions options_of(const py::dict& arguments) {
  ClientOptions options;
  const auto take = [&](const char* name, auto& member) {
    if (!arguments.contains(name)) return;
    member = argument<std::remove_reference_t<decltype(member)>>(arguments[name], name);
  };
  take("url", options.url);
  take("prefix", options.prefix);
  take("client_id", options.client_id);
  take("deadline_s", options.deadline_s);
  take("change_deadline_s", options.change_deadline_s);
  take("try_timeout_s", options.try_timeout_s);
  take("backoff", options.backoff);
  take("max_try_timeout_s", options.max_try_timeout_s);
  take("jitter", options.jitter);
  take("seed", options.seed);
  take("watch_lease_s", options.watch_lease_s);
  take("successor_wait_s", options.successor_wait_s);
  take("retries", options.retries);
  std::optional<std::string> key_file;
  take("key_file", key_file);
  if (!key_file) return options;
  double window_s = 30.0;
  take("key_window_s", window_s);
  const LoadedAuthentication loaded = authentication_from(*key_file, window_s);
  if (!loaded.authentication) throw Failed{Status::kInvalid, loaded.error};
  options.authentication = loaded.authentication;
  return options;
}

/// A client with calls that wait without the GIL and can be interrupted. Thread-safe.
class NativeClient {
 public:
  explicit NativeClient(const py::dict& arguments) : process_(::getpid()) {
    const CountedCall counted;
    const ClientOptions options = options_of(arguments);
    const WithoutGil others_may_run;
    client_ = std::make_shared<Client>(options);
    if (client_->good()) return;
    const Status status = fails_by_network() ? Status::kNetworkUnusable : Status::kInvalid;
    throw Failed{status, client_->error()};
  }
  ~NativeClient() { close(); }
  NativeClient(const NativeClient&) = delete;
  NativeClient& operator=(const NativeClient&) = delete;

  /// Ends all calls. Handlers need the GIL to end, so it is released.
  void close() {
    const CountedCall counted;
    std::shared_ptr<Client> client = std::exchange(client_, nullptr);
    if (!client) return;
    if (process_ != ::getpid()) {
      // The threads of the client are in the process that this one was forked from. There is
      // nothing to join here, so it is left as it is.
      new std::shared_ptr<Client>(std::move(client));
      return;
    }
    const WithoutGil others_may_run;
    client->cancel_scene_calls();
    // Other threads that wait for an answer hold the client. Then its handlers stay, and do
    // nothing.
    client.reset();
    gate_->close();
  }

  [[nodiscard]] bool is_closed() const { return !client_; }

  /// Returns the client, which the caller keeps while it uses it.
  [[nodiscard]] std::shared_ptr<Client> client() const {
    if (!client_) throw Failed{Status::kInvalid, "this client is closed"};
    if (process_ != ::getpid()) {
      throw Failed{Status::kInvalid,
                   "this client belongs to the process that this one was forked from; make another "
                   "one after the fork"};
    }
    return client_;
  }

  /// Throws where no answer comes while the caller waits: in a handler of this client, and in a
  /// process that was forked from the client's. The end of a closed client has been told already.
  void refuse_to_wait() const {
    if (client_) static_cast<void>(client_to_wait_for());
  }

  py::object plan(py::handle request_object, py::handle timeout, const py::object& on_progress) {
    const CountedCall counted;
    const auto request = argument<PlanRequest>(request_object, "request");
    const std::optional<double> timeout_s = timeout_of(timeout);
    const std::shared_ptr<Client> client = client_to_wait_for();
    PendingPlan pending = start(*client, request, handlers_for(on_progress, py::none()));
    const auto cancel = [&] { client->cancel(pending.request_id); };
    const auto end = timeout_s ? after(*timeout_s) : no_end();
    if (wait_for(pending.answer, end, cancel)) return lazy_to_python(pending.answer.get());
    cancel();
    if (wait_for(pending.answer, steady_clock::now() + kCancelGrace, cancel)) {
      PlanResponse answer = pending.answer.get();
      if (answer.status != Status::kCancelled) return lazy_to_python(std::move(answer));
    }
    PlanResponse answer;
    answer.status = Status::kTimeout;
    answer.request_id = pending.request_id;
    answer.error = "no answer came within " + std::string(py::str(py::float_(*timeout_s))) +
                   " s (timeout_s), so the request was cancelled";
    return lazy_to_python(std::move(answer));
  }

  std::int64_t plan_async(py::handle request_object, const py::object& on_answer,
                          const py::object& on_progress) {
    const CountedCall counted;
    const auto request = argument<PlanRequest>(request_object, "request");
    const std::shared_ptr<Client> client = this->client();
    return start(*client, request, handlers_for(on_progress, on_answer)).request_id;
  }

  std::int64_t watch(py::handle request_object, const py::function& on_event) {
    const CountedCall counted;
    const auto request = argument<PlanRequest>(request_object, "request");
    const std::shared_ptr<Client> client = this->client();
    const Callback handler(gate_, on_event);
    const WithoutGil others_may_run;
    return client->watch(request, [handler](const WatchEvent& event) { handler(event); });
  }

  /// Calls `ask(client)` in a thread, so that a signal can end the wait. The thread ends by itself
  /// if it is not waited for, and holds the client until then.
  template <class Ask>
  auto wait_for_call(Ask ask) {
    const CountedCall counted;
    using Answer = decltype(ask(*client_));
    const std::shared_ptr<Client> client = client_to_wait_for();
    auto task = std::make_shared<std::packaged_task<Answer()>>(
        [held = client, ask = std::move(ask)]() mutable {
          // Whoever waits may close the client right after the answer.
          const std::shared_ptr<Client> mine = std::move(held);
          return ask(*mine);
        });
    std::future<Answer> answer = task->get_future();
    std::thread([task] { (*task)(); }).detach();
    wait_for(answer, no_end(), [&] { client->cancel_scene_calls(); });
    return answer.get();
  }
  template <class Ask>
  py::object ask(Ask ask) {
    const CountedCall counted;
    return to_python(wait_for_call(std::move(ask)));
  }

 private:
  /// Returns the client. Throws in its handlers, without whose end no answer comes. The client
  /// itself would not notice: the wait is in other threads, or in none of its functions.
  [[nodiscard]] std::shared_ptr<Client> client_to_wait_for() const {
    if (gate_->is_this_thread_inside()) {
      throw Failed{Status::kBusy,
                   "a handler of this client must not wait for it; use plan_async there"};
    }
    return client();
  }

  /// Whether a client without an error in its options has one, which LCM has.
  [[nodiscard]] bool fails_by_network() const {
    return client_->status(0.0).status == Status::kNetworkUnusable;
  }

  PlanHandlers handlers_for(const py::object& on_progress, const py::object& on_answer) const {
    if (!on_progress.is_none() && PyCallable_Check(on_progress.ptr()) == 0) {
      throw ConversionFault(ConversionFault::Kind::kType,
                            "must be a function, not " + type_name(on_progress))
          .within("on_progress");
    }
    PlanHandlers handlers;
    if (!on_progress.is_none()) {
      handlers.on_progress = [call = Callback(gate_, on_progress)](const PlanProgress& now) {
        call(now);
      };
    }
    if (!on_answer.is_none()) {
      handlers.on_answer = [call = Callback(gate_, on_answer)](const PlanResponse& answer) {
        call(answer);
      };
    }
    return handlers;
  }

  static PendingPlan start(Client& client, const PlanRequest& request, PlanHandlers handlers) {
    const WithoutGil others_may_run;
    return client.plan_async(request, std::move(handlers));
  }

  std::shared_ptr<Client> client_;
  std::shared_ptr<CallGate> gate_ = std::make_shared<CallGate>();
  pid_t process_;
};

std::string text(py::handle value, const char* name) { return argument<std::string>(value, name); }
std::int64_t id_of(py::handle value) { return argument<std::int64_t>(value, "request_id"); }

void add_plan_calls(py::class_<NativeClient>& type) {
  type.def(py::init<const py::dict&>(), py::arg("options"))
      .def("close", &NativeClient::close)
      .def_property_readonly("is_closed", &NativeClient::is_closed)
      .def_property_readonly("warning",
                             [](const NativeClient& mine) { return mine.client()->warning(); })
      .def_property_readonly("client_id",
                             [](const NativeClient& mine) { return mine.client()->client_id(); })
      .def("refuse_to_wait", &NativeClient::refuse_to_wait)
      .def("plan", &NativeClient::plan, py::arg("request"), py::arg("timeout_s"),
           py::arg("on_progress"))
      .def("plan_async", &NativeClient::plan_async, py::arg("request"), py::arg("on_answer"),
           py::arg("on_progress"))
      .def(
          "cancel", [](NativeClient& mine, py::handle id) { mine.client()->cancel(id_of(id)); },
          py::arg("request_id"))
      .def("watch", &NativeClient::watch, py::arg("request"), py::arg("on_event"))
      .def(
          "unwatch", [](NativeClient& mine, py::handle id) { mine.client()->unwatch(id_of(id)); },
          py::arg("request_id"))
      .def(
          "unwatch_and_wait",
          [](NativeClient& mine, py::handle request_id, py::handle timeout) {
            return mine.wait_for_call(
                [id = id_of(request_id), timeout_s = timeout_of(timeout).value_or(0.0)](
                    Client& client) { return client.unwatch(id, timeout_s); });
          },
          py::arg("request_id"), py::arg("timeout_s"))
      .def(
          "take_better",
          [](NativeClient& mine, py::handle id) { mine.client()->take_better(id_of(id)); },
          py::arg("request_id"))
      .def(
          "status",
          [](NativeClient& mine, py::handle timeout) {
            const double timeout_s = timeout_of(timeout).value_or(kStatusTimeout_s);
            return mine.ask([=](Client& client) { return client.status(timeout_s); });
          },
          py::arg("timeout_s"))
      .def(
          "occupancy",
          [](NativeClient& mine, py::handle batch) {
            return mine.ask([batch = argument<OccupancyBatch>(batch, "batch")](Client& client) {
              return client.occupancy(batch);
            });
          },
          py::arg("batch"));
}

void add_scene_calls(py::class_<NativeClient>& type) {
  type.def(
          "load_scene",
          [](NativeClient& mine, py::handle scene, py::handle mesh, py::handle resolution,
             py::handle bounds) {
            return mine.ask([mesh = argument<SceneMesh>(mesh, "mesh"),
                             resolution_m = argument<double>(resolution, "occupancy_resolution_m"),
                             bounds = argument<Bounds>(bounds, "body_bounds"),
                             scene = text(scene, "scene")](Client& client) {
              return client.load_scene(scene, mesh, resolution_m, bounds);
            });
          },
          py::arg("scene"), py::arg("mesh"), py::arg("occupancy_resolution_m"),
          py::arg("body_bounds"))
      .def(
          "unload_scene",
          [](NativeClient& mine, py::handle scene) {
            return mine.ask([scene = text(scene, "scene")](Client& client) {
              return client.unload_scene(scene);
            });
          },
          py::arg("scene"))
      .def("list_scenes",
           [](NativeClient& mine) {
             return mine.ask([](Client& client) { return client.list_scenes(); });
           })
      .def(
          "describe_scene",
          [](NativeClient& mine, py::handle scene) {
            return mine.ask([scene = text(scene, "scene")](Client& client) {
              return client.describe_scene(scene);
            });
          },
          py::arg("scene"))
      .def(
          "scene_history",
          [](NativeClient& mine, py::handle scene) {
            return mine.ask([scene = text(scene, "scene")](Client& client) {
              return client.scene_history(scene);
            });
          },
          py::arg("scene"))
      .def(
          "restore_scene",
          [](NativeClient& mine, py::handle scene, py::handle revision, py::handle as) {
            return mine.ask([scene = text(scene, "scene"),
                             revision = argument<std::int64_t>(revision, "revision"),
                             as = text(as, "restore_as")](Client& client) {
              return client.restore_scene(scene, revision, as);
            });
          },
          py::arg("scene"), py::arg("revision"), py::arg("restore_as"))
      .def("cancel_scene_calls", [](NativeClient& mine) {
        const CountedCall counted;
        const std::shared_ptr<Client> client = mine.client();
        const WithoutGil others_may_run;
        client->cancel_scene_calls();
      });
}

void add_object_calls(py::class_<NativeClient>& type) {
  type.def(
          "put_object",
          [](NativeClient& mine, py::handle scene, py::handle object, py::handle shape,
             py::handle pose) {
            return mine.ask([shape = argument<SceneShape>(shape, "shape"),
                             pose = argument<Pose>(pose, "pose"), scene = text(scene, "scene"),
                             object = text(object, "object")](Client& client) {
              return client.put_object(scene, object, shape, pose);
            });
          },
          py::arg("scene"), py::arg("object"), py::arg("shape"), py::arg("pose"))
      .def(
          "move_object",
          [](NativeClient& mine, py::handle scene, py::handle object, py::handle pose) {
            return mine.ask([pose = argument<Pose>(pose, "pose"), scene = text(scene, "scene"),
                             object = text(object, "object")](Client& client) {
              return client.move_object(scene, object, pose);
            });
          },
          py::arg("scene"), py::arg("object"), py::arg("pose"))
      .def(
          "remove_object",
          [](NativeClient& mine, py::handle scene, py::handle object) {
            return mine.ask([scene = text(scene, "scene"), object = text(object, "object")](
                                Client& client) { return client.remove_object(scene, object); });
          },
          py::arg("scene"), py::arg("object"))
      .def(
          "object_triangles",
          [](NativeClient& mine, py::handle scene, py::handle digest) {
            return mine.ask([scene = text(scene, "scene"), digest = text(digest, "digest")](
                                Client& client) { return client.object_triangles(scene, digest); });
          },
          py::arg("scene"), py::arg("digest"));
}

void add_map_calls(py::class_<NativeClient>& type) {
  type.def(
          "insert_scan",
          [](NativeClient& mine, py::handle scene, py::handle object, py::handle points_m,
             py::handle origin_m) {
            using Points = std::vector<std::array<double, 3>>;
            return mine.ask([points = argument<Points>(points_m, "points_m"),
                             origin = argument<std::array<double, 3>>(origin_m, "origin_m"),
                             scene = text(scene, "scene"),
                             object = text(object, "object")](Client& client) {
              return client.insert_scan(scene, object, points, origin);
            });
          },
          py::arg("scene"), py::arg("object"), py::arg("points_m"), py::arg("origin_m"))
      .def(
          "export_map",
          [](NativeClient& mine, py::handle scene) {
            return mine.ask([scene = text(scene, "scene")](Client& client) {
              return client.export_map(scene);
            });
          },
          py::arg("scene"))
      .def(
          "export_map_to",
          [](NativeClient& mine, py::handle scene, py::handle file) {
            return mine.ask([scene = text(scene, "scene"), file = text(file, "file")](
                                Client& client) { return client.export_map_to(scene, file); });
          },
          py::arg("scene"), py::arg("file"));
}

}  // namespace

void add_client(py::module_& module) {
  py::class_<NativeClient> type(
      module, "NativeClient",
      "`camway::Client` for the class `camway.Client`, which documents its "
      "members. Answers are returned whatever their status.");
  add_plan_calls(type);
  add_scene_calls(type);
  add_object_calls(type);
  add_map_calls(type);
  module.def(
      "latency_quantile_s",
      [](py::handle latency, double q) {
        return argument<Latency>(latency, "latency").quantile_s(q);
      },
      py::arg("latency"), py::arg("q"));
  module.def(
      "latency_since",
      [](py::handle latency, py::handle before) {
        return to_python(
            argument<Latency>(latency, "latency").since(argument<Latency>(before, "before")));
      },
      py::arg("latency"), py::arg("before"));
}

}  // namespace camway::python
