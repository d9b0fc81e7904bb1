// SPDX-License-Identifier: MIT
#include "daemon/nats/security_files.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

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

template <auto kFree>
struct Freed {
  template <class T>
  void operator()(T* thing) const {
    kFree(thing);
  }
};
using Bio = std::unique_ptr<BIO, Freed<BIO_free>>;
using Certificate = std::unique_ptr<X509, Freed<X509_free>>;
using Key = std::unique_ptr<EVP_PKEY, Freed<EVP_PKEY_free>>;

/// Stands for the user who would be asked for a password; notes that there was a question.
int no_password(char* /*password*/, int /*size*/, int /*is_new*/, void* was_asked) {
  *static_cast<bool*>(was_asked) = true;
  return 0;
}

Bio bio_of(const std::string& text) {
  return Bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
}

std::vector<Certificate> certificates_in(const std::string& text) {
  std::vector<Certificate> certificates;
  const Bio bio = bio_of(text);
  bool was_asked = false;
  while (X509* const read = PEM_read_bio_X509(bio.get(), nullptr, no_password, &was_asked)) {
    certificates.emplace_back(read);
  }
  // The end of the text is an error to the library.
  ERR_clear_error();
  return certificates;
}

/// Returns why a certificate does not hold now; empty if it does.
std::string fault_of_time(const X509* certificate) {
  if (X509_cmp_current_time(X509_get0_notAfter(certificate)) < 0) return "has expired";
  if (X509_cmp_current_time(X509_get0_notBefore(certificate)) > 0) return "is not valid yet";
  return "";
}

class Check {
 public:
  void credentials(const std::string& file) {
    std::string fault = read(file);
    for (const std::string_view mark : {"BEGIN NATS USER JWT", "BEGIN USER NKEY SEED"}) {
      if (fault.empty() && text_.find(mark) == std::string::npos) {
        fault = file + " is no file of credentials: it has no '" + std::string(mark) + "'";
      }
    }
    add(File::kCredentials, std::move(fault));
  }

  void authorities(const std::string& file) {
    const std::vector<Certificate> certificates = read_certificates(File::kCa, file);
    // A file of many authorities is good if one of them holds now.
    if (certificates.empty()) return;
    std::string fault;
    for (const Certificate& each : certificates) {
      fault = fault_of_time(each.get());
      if (fault.empty()) return;
    }
    add(File::kCa, file + " " + fault);
  }

  void certificate(const std::string& file, const std::string& key_file) {
    const std::vector<Certificate> chain = read_certificates(File::kCertificate, file);
    if (!chain.empty()) {
      const std::string fault = fault_of_time(chain.front().get());
      if (!fault.empty()) add(File::kCertificate, file + " " + fault);
    }
    const Key key = read_key(key_file);
    if (key && !chain.empty() && X509_check_private_key(chain.front().get(), key.get()) != 1) {
      add(File::kKey, key_file + " is not the key of " + file);
    }
    ERR_clear_error();
  }

  [[nodiscard]] std::vector<SecurityFileFault> take() { return std::move(faults_); }

 private:
  void add(File file, std::string reason) {
    if (!reason.empty()) faults_.push_back({file, std::move(reason)});
  }

  /// Reads a file into `text_`. Returns why that is not possible.
  std::string read(const std::string& file) {
    Content content = content_of(file);
    text_ = std::move(content.text);
    return std::move(content.fault);
  }

  std::vector<Certificate> read_certificates(File kind, const std::string& file) {
    std::string fault = read(file);
    std::vector<Certificate> certificates;
    if (fault.empty()) {
      certificates = certificates_in(text_);
      if (certificates.empty()) fault = file + " has no certificate in PEM that can be read";
    }
    add(kind, std::move(fault));
    return certificates;
  }

  Key read_key(const std::string& file) {
    std::string fault = read(file);
    if (!fault.empty()) {
      add(File::kKey, std::move(fault));
      return nullptr;
    }
    bool was_asked = false;
    Key key(PEM_read_bio_PrivateKey(bio_of(text_).get(), nullptr, no_password, &was_asked));
    ERR_clear_error();
    if (was_asked) {
      add(File::kKey, file + " is encrypted, which is not supported");
    } else if (!key) {
      add(File::kKey, file + " has no key in PEM that can be read");
    }
    return key;
  }

  std::string text_;
  std::vector<SecurityFileFault> faults_;
};

}  // namespace

std::vector<SecurityFileFault> faults_of_security_files(const ConnectOptions& options) {
  Check check;
  if (!options.credentials_file.empty()) check.credentials(options.credentials_file);
  if (!options.ca_file.empty()) check.authorities(options.ca_file);
  if (!options.certificate_file.empty() && !options.key_file.empty()) {
    check.certificate(options.certificate_file, options.key_file);
  }
  return check.take();
}

}  // namespace camway::nats
