// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/integration/process.h"
#include "tests/support/temporary_folder.h"

namespace camway::testing {

/// Returns a port of the loopback that was free a moment ago.
int free_port();

/// A server of NATS on the loopback, with a folder of its own, that a test may kill, stop and start
/// again. Throws if it does not start.
class NatsServer {
 public:
  static constexpr const char* kJetStream = "jetstream { store_dir: \"STORE\" }\n";

  /// `configuration`: in the server's own words; STORE and FOLDER stand for its folders.
  explicit NatsServer(std::string configuration = kJetStream);

  /// Sets the configuration of the next start.
  void configure(std::string configuration) const;
  /// Starts a server that was killed, on the same port and folder.
  void start();
  /// As if the process had crashed: nothing that the kernel has is lost.
  void kill();
  /// Stops the process where it is, and returns when it has stopped; connections stay open.
  void pause() const;
  void resume() const;

  /// Copies what the server has in its files now. Requires that it is killed or has nothing to do.
  void keep_copy() const;
  /// Puts that copy in the place of the files, as if the machine had lost power since then.
  /// Requires that the server is killed.
  void restore_copy() const;

  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] std::string url() const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }
  [[nodiscard]] std::string output() const { return process_->output(); }

 private:
  [[nodiscard]] std::filesystem::path store() const { return folder_.path() / "store"; }
  [[nodiscard]] std::filesystem::path copy() const { return folder_.path() / "copy"; }

  TemporaryFolder folder_;
  int port_;
  std::unique_ptr<integration::Process> process_;
};

/// Three servers that keep streams together.
class NatsCluster {
 public:
  NatsCluster();

  [[nodiscard]] std::vector<std::string> urls() const;
  NatsServer& server(const std::string& name);
  /// The server that was chosen first to lead a stream, and still does unless one has failed.
  NatsServer& first_leader_of(const std::string& stream);

 private:
  std::vector<std::string> names_;
  std::vector<std::unique_ptr<NatsServer>> servers_;
};

/// Certificates for servers and clients on the loopback, signed by an authority of their own.
class TestCertificates {
 public:
  TestCertificates();

  [[nodiscard]] std::string ca() const { return file("ca.pem"); }
  [[nodiscard]] std::string server() const { return file("server.pem"); }
  [[nodiscard]] std::string server_key() const { return file("server.key"); }
  /// For a host of another name.
  [[nodiscard]] std::string stranger() const { return file("stranger.pem"); }
  [[nodiscard]] std::string stranger_key() const { return file("stranger.key"); }
  [[nodiscard]] std::string client() const { return file("client.pem"); }
  [[nodiscard]] std::string client_key() const { return file("client.key"); }
  /// Makes another certificate for the client's key; it has expired if `days` is negative.
  [[nodiscard]] std::string valid_for_days(int days) const;
  /// Makes a copy of the client's key that needs a password.
  [[nodiscard]] std::string encrypted_client_key() const;

 private:
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  void run(const std::vector<std::string>& arguments) const;
  void sign(const std::string& name, const std::string& names) const;

  TemporaryFolder folder_;
};

}  // namespace camway::testing
