// SPDX-License-Identifier: MIT
#include "tools/view/door.h"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/http/server.h"
#include "tools/view/access/access.h"
#include "tools/view/desk.h"
#include "tools/view/export.h"
#include "tools/view/http_jobs.h"
#include "tools/view/mesh_desk.h"
#include "tools/view/plan_picture.h"
#include "tools/view/responses.h"
#include "tools/view/review/review.h"
#include "tools/view/routes.h"
#include "tools/view/session.h"

namespace camway::view {
namespace {

constexpr char kHtmlType[] = "text/html; charset=utf-8";
constexpr char kCssType[] = "text/css; charset=utf-8";
constexpr char kScriptType[] = "text/javascript; charset=utf-8";

/// Returns a function that sends an answer as JSON.
Done in_json(http::Reply send) {
  return [send = std::move(send)](Answer answer) { send(to_response(std::move(answer))); };
}

class DoorServer final : public Door {
 public:
  DoorServer(const DoorOptions& options, Backend& backend)
      : page_(options.page),
        lock_{options.port, options.token},
        desk_(std::make_shared<Desk>(options, backend)),
        meshes_(std::make_shared<MeshDesk>(backend)),
        jobs_(std::make_shared<HttpJobs>(options.limits.requests)) {}
  ~DoorServer() override {
    jobs_->close();
    server_.reset();
    desk_->stop();
    meshes_->stop();
  }
  DoorServer(const DoorServer&) = delete;
  DoorServer& operator=(const DoorServer&) = delete;

  /// Returns why the door cannot be opened; empty if it is open.
  std::string listen(int port);

  [[nodiscard]] int port() const override { return lock_.port; }
  [[nodiscard]] std::string url() const override {
    return fmt::format("http://127.0.0.1:{}/?token={}", lock_.port, lock_.token);
  }

 private:
  [[nodiscard]] std::optional<http::Response> refuse(const http::Request& request) const;
  void answer(const http::Request& request, const http::Reply& reply);
  void draw(const http::Reply& reply);
  /// Returns a file of the page.
  [[nodiscard]] http::Response page(const http::Request& request, Place place) const;

  /// Takes a place for a request over HTTP, and returns what answers it and leaves the place. Null
  /// if there is no place, which the reply says.
  http::Reply begin(const http::Reply& reply, HttpJobs::Ticket& ticket);
  /// Sends the mesh of an object.
  void send_mesh(const Route& route, const http::Reply& reply);
  void ask(const http::Request& request, const http::Reply& reply, const Route& route);
  /// Reads the body of a request and has it answered. `named` has the names of the target, and the
  /// format of an export as its object. Runs on a thread of the desk.
  void read_body(const std::string& body, Place place, SceneOrder named, HttpJobs::Ticket ticket,
                 const http::Reply& send);
  /// Has a document answered in JSON.
  void read_document(const nlohmann::json& document, Place place, const SceneOrder& named,
                     HttpJobs::Ticket ticket, Done done);
  void plan(const nlohmann::json& document, HttpJobs::Ticket ticket, Done done);
  void check(const nlohmann::json& document, HttpJobs::Ticket ticket, Done done);
  void interpolate(const nlohmann::json& document, Done done);
  void triangles(const nlohmann::json& document, const std::string& scene, Done done);
  void change(base::Result<SceneOrder> order, const SceneOrder& named, Done done);
  void review(const nlohmann::json& document, const http::Reply& send);
  /// Sends the path in a format, which a parameter of the target names.
  void send_export(const nlohmann::json& document, std::string_view format,
                   const http::Reply& send);

  const PageFiles page_;
  Lock lock_;  ///< read by the server's thread once the port is set
  const std::shared_ptr<Desk> desk_;
  const std::shared_ptr<MeshDesk> meshes_;
  const std::shared_ptr<HttpJobs> jobs_;
  std::unique_ptr<http::Server> server_;
};

std::string DoorServer::listen(int port) {
  http::Handlers handlers;
  handlers.headers = common_headers();
  handlers.on_head = [this](const http::Request& request) { return refuse(request); };
  handlers.on_request = [this](const http::Request& request, const http::Reply& reply) {
    answer(request, reply);
  };
  handlers.on_socket =
      [this](const http::Request& request,
             std::shared_ptr<http::Socket> socket) -> std::unique_ptr<http::SocketEvents> {
    const Route route = route_of(request.method, request.target);
    if (route.place != Place::kSocket || route.code != code::kOk) return nullptr;
    return open_session(desk_, std::move(socket));
  };
  const DoorLimits& limits = desk_->limits();
  http::Limits http_limits;
  http_limits.connections = limits.connections;
  http_limits.body_bytes = limits.body_bytes;
  http_limits.message_bytes = limits.message_bytes;
  http_limits.queued_bytes = limits.queued_bytes;
  auto opened = http::Server::open({"127.0.0.1", port}, std::move(handlers), http_limits,
                                   [this](int bound) { lock_.port = bound; });
  if (!opened) return opened.error;
  server_ = *std::move(opened);
  return {};
}

std::optional<http::Response> DoorServer::refuse(const http::Request& request) const {
  std::string why = why_refused(request, lock_);
  if (why.empty()) return std::nullopt;
  return refusal(code::kForbidden, std::move(why));
}

void DoorServer::answer(const http::Request& request, const http::Reply& reply) {
  const Route route = route_of(request.method, request.target);
  if (route.code == code::kNotFound) {
    return reply(refusal(route.code, "there is no such place; docs/http.md lists them"));
  }
  if (route.code == code::kNotAllowed) {
    http::Response response =
        refusal(route.code, fmt::format("the method must be {}", route.allowed));
    response.headers.emplace_back("Allow", route.allowed);
    return reply(std::move(response));
  }
  switch (route.place) {
    case Place::kPage:
    case Place::kScript:
    case Place::kStyle:
      return reply(page(request, route.place));
    case Place::kPicture:
      return draw(reply);
    case Place::kVersion:
      return reply(to_response(Desk::version()));
    case Place::kFields:
      return reply(to_response(Desk::fields()));
    case Place::kLast:
      return reply(to_response(desk_->last()));
    case Place::kSocket:
      return reply(refusal(code::kInvalid, "this place is a WebSocket"));
    default:
      return ask(request, reply, route);
  }
}

http::Response DoorServer::page(const http::Request& request, Place place) const {
  const auto [file, type] = place == Place::kPage     ? std::pair(page_.html, kHtmlType)
                            : place == Place::kScript ? std::pair(page_.script, kScriptType)
                                                      : std::pair(page_.style, kCssType);
  if (file.text.empty()) {
    return refusal(code::kNotFound, "this program was built without its page");
  }
  http::Response response = file_response(file, type, lock_.port, request);
  // A browser that came by the printed address gets a cookie, so that pages need no token.
  if (place == Place::kPage && request.target.size() > 1) {
    response.headers.emplace_back("Set-Cookie", cookie_for(lock_));
  }
  return response;
}

void DoorServer::draw(const http::Reply& reply) {
  const std::shared_ptr<const LastPlan> last = desk_->backend().last();
  if (!last || last->result.path.empty()) {
    return reply(refusal(code::kNotFound, "there is no path to draw"));
  }
  desk_->post([last, reply] {
    std::string picture = plan_picture(*last);
    if (picture.empty()) return reply(refusal(code::kOurFault, "the path cannot be drawn"));
    reply(picture_response(std::move(picture)));
  });
}

http::Reply DoorServer::begin(const http::Reply& reply, HttpJobs::Ticket& ticket) {
  ticket = jobs_->enter();
  if (ticket == 0) {
    reply(refusal(code::kTooMany, fmt::format("too many at a time: at most {} requests",
                                              desk_->limits().requests)));
    return nullptr;
  }
  return [jobs = jobs_, ticket, reply](http::Response response) {
    jobs->leave(ticket);
    reply(std::move(response));
  };
}

void DoorServer::send_mesh(const Route& route, const http::Reply& reply) {
  meshes_->ask(std::string(route.scene), std::string(route.object), [reply](GlbAnswer answer) {
    if (!answer.glb) return reply(refusal(answer.code, std::move(answer.error)));
    reply({code::kOk, "model/gltf-binary", *answer.glb, {}});
  });
}

void DoorServer::ask(const http::Request& request, const http::Reply& reply, const Route& route) {
  HttpJobs::Ticket ticket = 0;
  http::Reply send = begin(reply, ticket);
  if (!send) return;
  if (route.place == Place::kMesh) return send_mesh(route, send);
  Done done = in_json(send);
  // Ahead of the body, which may be wrong: what it says does not count.
  if (route.place == Place::kObjects || route.place == Place::kObject) {
    if (std::optional<Answer> refusal = desk_->refuse_change()) return done(*std::move(refusal));
  }
  SceneOrder order;
  order.scene = route.scene;
  order.object =
      route.place == Place::kExport ? parameter_of(request.target, "format") : route.object;
  switch (route.place) {
    case Place::kStatus:
      return desk_->status(std::move(done));
    case Place::kScenes:
      return desk_->ask_scene(std::move(order), std::move(done));
    case Place::kScene:
      order.kind = SceneOrder::Kind::kDescribe;
      return desk_->ask_scene(std::move(order), std::move(done));
    default:
      break;
  }
  if (request.method == "DELETE") {
    order.kind = SceneOrder::Kind::kRemove;
    return desk_->ask_scene(std::move(order), std::move(done));
  }
  // The route refers to the target of the request, which ends with this call.
  desk_->post([this, body = request.body, place = route.place, order = std::move(order), ticket,
               send = std::move(send)]() mutable {
    read_body(body, place, std::move(order), ticket, send);
  });
}

void DoorServer::read_body(const std::string& body, Place place, SceneOrder named,
                           HttpJobs::Ticket ticket, const http::Reply& send) {
  const base::Result<nlohmann::json> document = tools::parse_document(body, "request");
  if (!document) return send(refusal(code::kInvalid, document.error));
  if (place == Place::kReview) return review(*document, send);
  if (place == Place::kExport) return send_export(*document, named.object, send);
  read_document(*document, place, named, ticket, in_json(send));
}

void DoorServer::read_document(const nlohmann::json& document, Place place, const SceneOrder& named,
                               HttpJobs::Ticket ticket, Done done) {
  switch (place) {
    case Place::kPlan:
      return plan(document, ticket, std::move(done));
    case Place::kCheck:
      return check(document, ticket, std::move(done));
    case Place::kInterpolate:
      return interpolate(document, std::move(done));
    case Place::kTriangles:
      return triangles(document, named.scene, std::move(done));
    case Place::kObjects:
      return change(read_added(document), named, std::move(done));
    default:
      return change(read_moved(document), named, std::move(done));
  }
}

void DoorServer::plan(const nlohmann::json& document, HttpJobs::Ticket ticket, Done done) {
  base::Result<PlanOrder> order = view::read_plan(document);
  if (!order) return done(failure(code::kInvalid, order.error));
  jobs_->set(ticket,
             desk_->backend().plan(desk_->in_scene(*std::move(order)), nullptr, std::move(done)));
}

void DoorServer::check(const nlohmann::json& document, HttpJobs::Ticket ticket, Done done) {
  base::Result<CheckOrder> order = read_check_document(document);
  if (!order) return done(failure(code::kInvalid, order.error));
  jobs_->set(ticket, desk_->backend().check(desk_->in_scene(*std::move(order)), std::move(done)));
}

void DoorServer::interpolate(const nlohmann::json& document, Done done) {
  base::Result<PlanOrder> order = view::read_plan(document);
  if (!order) return done(failure(code::kInvalid, order.error));
  desk_->interpolate(*std::move(order), std::move(done));
}

void DoorServer::triangles(const nlohmann::json& document, const std::string& scene, Done done) {
  base::Result<TrianglesOrder> order = read_triangles(document);
  if (!order) return done(failure(code::kInvalid, order.error));
  order->scene = scene;
  desk_->triangles(*std::move(order), std::move(done));
}

void DoorServer::change(base::Result<SceneOrder> order, const SceneOrder& named, Done done) {
  if (!order) return done(failure(code::kInvalid, order.error));
  order->scene = named.scene;
  // One that is added has its name in the body.
  if (!named.object.empty()) order->object = named.object;
  desk_->ask_scene(*std::move(order), std::move(done));
}

void DoorServer::review(const nlohmann::json& document, const http::Reply& send) {
  base::Result<ReviewOrder> order = read_review(document);
  if (!order) return send(refusal(code::kInvalid, order.error));
  order->plan = desk_->in_scene(std::move(order->plan));
  // It waits for the backend, which must not keep other requests waiting.
  meshes_->post([this, order = *std::move(order), send] {
    ReviewFile made = make_review(order, page_, desk_->backend(), *meshes_);
    if (made.code != code::kOk) return send(refusal(made.code, std::move(made.error)));
    send({code::kOk,
          kHtmlType,
          std::move(made.html),
          {{"Content-Disposition", "attachment; filename=\"review.html\""}}});
  });
}

void DoorServer::send_export(const nlohmann::json& document, std::string_view format,
                             const http::Reply& send) {
  ExportFile made = make_export(document, format);
  if (made.code != code::kOk) return send(refusal(made.code, std::move(made.error)));
  send({code::kOk,
        "application/octet-stream",
        std::move(made.bytes),
        {{"Content-Disposition", fmt::format("attachment; filename=\"{}\"", made.name)}}});
}

}  // namespace

base::Result<std::unique_ptr<Door>> Door::open(const DoorOptions& options, Backend& backend) {
  auto door = std::make_unique<DoorServer>(options, backend);
  std::string fault = door->listen(options.port);
  if (!fault.empty()) return base::Failure{std::move(fault)};
  return std::unique_ptr<Door>(std::move(door));
}

}  // namespace camway::view
