// SPDX-License-Identifier: MIT
#include "daemon/nats/security_files.h"

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "daemon/nats/connection_parts.h"

namespace camway::nats {
namespace {

using File = SecurityFileFault::File;

struct Content {
  std::string text;
  std::string fault;  ///< why it cannot be read; empty if it can
};

Content content_of(const std::string& file) {
  const auto fault = [&](int error) {
    return Content{"", file + " cannot be read: " + std::generic_category().message(error)};
  };
  std::ifstream stream(file, std::ios::binary);
  if (!stream.is_open()) return fault(errno);
  // A folder can be opened, but not read.
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) return fault(EISDIR);
  return {{std::istreambuf_iterator<char>(stream), {}}, ""};
}

/// Returns why a file is not of its kind; empty if it is, as far as its marks tell.
std::string fault_of_marks(const std::string& file, const std::vector<std::string_view>& marks,
                           std::string_view kind) {
  const Content content = content_of(file);
  if (!content.fault.empty()) return content.fault;
  for (const std::string_view mark : marks) {
    if (content.text.find(mark) == std::string::npos) {
      return file + " is no " + std::string(kind) + ": it has no '" + std::string(mark) + "'";
    }
  }
  return "";
}

class Check {
 public:
  explicit Check(natsOptions* options) : options_(options) {}

  void add(File file, std::string reason) {
    if (!reason.empty()) faults_.push_back({file, std::move(reason)});
  }
  void credentials(const std::string& file) {
    add(File::kCredentials, fault_of_marks(file, {"BEGIN NATS USER JWT", "BEGIN USER NKEY SEED"},
                                           "file of credentials"));
  }
  void authorities(const std::string& file) {
    std::string fault = fault_of_marks(file, {"BEGIN"}, "file of certificates in PEM");
    if (fault.empty() && natsOptions_LoadCATrustedCertificates(options_, file.c_str()) != NATS_OK) {
      fault = file + " has no certificate that can be read";
    }
    add(File::kCa, std::move(fault));
  }
  void certificate(const std::string& file, const std::string& key_file) {
    std::string fault = fault_of_marks(file, {"BEGIN"}, "certificate in PEM");
    std::string key_fault = fault_of_marks(key_file, {"BEGIN"}, "key in PEM");
    // A file of authorities takes what a chain of certificates takes.
    if (fault.empty() && natsOptions_LoadCATrustedCertificates(options_, file.c_str()) != NATS_OK) {
      fault = file + " has no certificate that can be read";
    }
    if (fault.empty() && key_fault.empty() &&
        natsOptions_LoadCertificatesChain(options_, file.c_str(), key_file.c_str()) != NATS_OK) {
      key_fault = key_file + " has no key that can be read, or not the key of " + file;
    }
    add(File::kCertificate, std::move(fault));
    add(File::kKey, std::move(key_fault));
  }
  [[nodiscard]] std::vector<SecurityFileFault> take() { return std::move(faults_); }

 private:
  natsOptions* options_;
  std::vector<SecurityFileFault> faults_;
};

/// Returns options of the library, which starts its threads with the first ones. Settings are read
/// before the program blocks the signals that it waits for; those threads must leave them to it.
NatsOwned<natsOptions> make_options() {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  natsOptions* made = nullptr;
  const natsStatus status = natsOptions_Create(&made);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return NatsOwned<natsOptions>(status == NATS_OK ? made : nullptr);
}

}  // namespace

std::vector<SecurityFileFault> faults_of_security_files(const ConnectOptions& options) {
  const NatsOwned<natsOptions> owned = make_options();
  if (owned == nullptr) return {};
  Check check(owned.get());
  if (!options.credentials_file.empty()) check.credentials(options.credentials_file);
  if (!options.ca_file.empty()) check.authorities(options.ca_file);
  if (!options.certificate_file.empty() && !options.key_file.empty()) {
    check.certificate(options.certificate_file, options.key_file);
  }
  return check.take();
}

}  // namespace camway::nats
