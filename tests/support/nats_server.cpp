// SPDX-License-Identifier: MIT
#include "tests/support/nats_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <csignal>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "daemon/base/file_descriptor.h"

namespace camway::testing {
namespace {

namespace fs = std::filesystem;

void replace_all(std::string& text, const std::string& word, const std::string& by) {
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at)) {
    text.replace(at, word.size(), by);
    at += by.size();
  }
}

}  // namespace

int free_port() {
  const base::FileDescriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  if (::bind(socket.get(), generic, size) != 0 ||
      ::getsockname(socket.get(), generic, &size) != 0) {
    throw std::runtime_error("no free port");
  }
  return ntohs(address.sin_port);
}

NatsServer::NatsServer(std::string configuration) : port_(free_port()) {
  configure(std::move(configuration));
  start();
}

void NatsServer::configure(std::string configuration) const {
  configuration += "listen: \"127.0.0.1:" + std::to_string(port_) + "\"\n";
  replace_all(configuration, "STORE", store().string());
  replace_all(configuration, "FOLDER", folder_.path().string());
  folder_.write("server.conf", configuration);
}

void NatsServer::start() {
  const std::string file = (folder_.path() / "server.conf").string();
  const std::string output = (folder_.path() / "output").string();
  process_ = std::make_unique<integration::Process>(
      std::vector<std::string>{NATS_SERVER_BINARY, "--config", file}, output);
  const bool is_ready = integration::eventually([&] {
    return process_->output().find("Server is ready") != std::string::npos || !process_->running();
  });
  if (!is_ready || !process_->running()) {
    throw std::runtime_error("nats-server does not start: " + process_->output());
  }
}

void NatsServer::kill() {
  process_->signal(SIGKILL);
  process_->wait();
}

void NatsServer::pause() const {
  process_->signal(SIGSTOP);
  // Its threads run on until the kernel has stopped the last one.
  siginfo_t stopped{};
  ::waitid(P_PID, static_cast<id_t>(process_->pid()), &stopped, WSTOPPED);
}

void NatsServer::resume() const { process_->signal(SIGCONT); }

void NatsServer::keep_copy() const {
  fs::remove_all(copy());
  fs::copy(store(), copy(), fs::copy_options::recursive);
}

void NatsServer::restore_copy() const {
  fs::remove_all(store());
  fs::copy(copy(), store(), fs::copy_options::recursive);
}

std::string NatsServer::url() const { return "nats://127.0.0.1:" + std::to_string(port_); }

NatsCluster::NatsCluster() {
  std::vector<int> ports;
  std::string routes;
  for (int i = 0; i < 3; ++i) {
    ports.push_back(free_port());
    routes += std::string(routes.empty() ? "" : ", ") +
              "\"nats://127.0.0.1:" + std::to_string(ports.back()) + "\"";
  }
  for (const int port : ports) {
    const std::string number = std::to_string(port);
    names_.push_back("s" + number);
    servers_.push_back(std::make_unique<NatsServer>(
        std::string(NatsServer::kJetStream) + "server_name: \"" + names_.back() +
        "\"\ncluster { name: \"test\", listen: \"127.0.0.1:" + number + "\", routes: [" + routes +
        " ] }\n"));
  }
}

std::vector<std::string> NatsCluster::urls() const {
  std::vector<std::string> urls;
  for (const auto& server : servers_) urls.push_back(server->url());
  return urls;
}

NatsServer& NatsCluster::server(const std::string& name) {
  for (std::size_t i = 0; i < servers_.size(); ++i) {
    if (names_[i] == name) return *servers_[i];
  }
  throw std::runtime_error("no server has the name " + name);
}

NatsServer& NatsCluster::first_leader_of(const std::string& stream) {
  const std::string words = "stream leader for '$G > " + stream + "'";
  for (const auto& server : servers_) {
    if (server->output().find(words) != std::string::npos) return *server;
  }
  throw std::runtime_error("no server says that it leads " + stream);
}

TestCertificates::TestCertificates() {
  run({"req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes",
       "-days", "2", "-subj", "/CN=test authority", "-keyout", file("ca.key"), "-out", ca()});
  sign("server", "DNS:localhost,IP:127.0.0.1");
  sign("stranger", "DNS:elsewhere.example");
  sign("client", "DNS:client.example");
}

std::string TestCertificates::valid_for_days(int days) const {
  const std::string made = file("client_" + std::to_string(days) + ".pem");
  run({"x509", "-req", "-in", file("client.csr"), "-CA", ca(), "-CAkey", file("ca.key"),
       "-CAcreateserial", "-days", std::to_string(days), "-out", made});
  return made;
}

std::string TestCertificates::encrypted_client_key() const {
  const std::string made = file("encrypted.key");
  run({"pkcs8", "-topk8", "-in", client_key(), "-passout", "pass:secret", "-out", made});
  return made;
}

void TestCertificates::run(const std::vector<std::string>& arguments) const {
  std::vector<std::string> command{OPENSSL_BINARY};
  command.insert(command.end(), arguments.begin(), arguments.end());
  integration::Process process(command, file("output"));
  if (process.wait() != 0) throw std::runtime_error("openssl failed: " + process.output());
}

void TestCertificates::sign(const std::string& name, const std::string& names) const {
  run({"req", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-subj",
       "/CN=" + name, "-keyout", file(name + ".key"), "-out", file(name + ".csr")});
  folder_.write(name + ".ext", "subjectAltName=" + names + "\n");
  run({"x509", "-req", "-in", file(name + ".csr"), "-CA", ca(), "-CAkey", file("ca.key"),
       "-CAcreateserial", "-days", "2", "-extfile", file(name + ".ext"), "-out",
       file(name + ".pem")});
}

}  // namespace camway::testing
