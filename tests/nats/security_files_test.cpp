// SPDX-License-Identifier: MIT
#include "daemon/nats/security_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/nats_server.h"
#include "tests/support/temporary_folder.h"

namespace camway::nats {
namespace {

using File = SecurityFileFault::File;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::TemporaryFolder;
using testing::TestCertificates;

auto fault(File file, const std::string& words) {
  return AllOf(Field(&SecurityFileFault::file, file),
               Field(&SecurityFileFault::reason, HasSubstr(words)));
}

std::string text_of(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(NatsSecurityFiles, GoodOnesAndNoneHaveNoFault) {
  const TestCertificates certificates;
  const TemporaryFolder folder;
  ConnectOptions options;
  EXPECT_THAT(faults_of_security_files(options), IsEmpty());
  options.ca_file = certificates.ca();
  options.certificate_file = certificates.client();
  options.key_file = certificates.client_key();
  folder.write("a.creds",
               "-----BEGIN NATS USER JWT-----\nx\n------END NATS USER JWT------\n"
               "-----BEGIN USER NKEY SEED-----\ny\n------END USER NKEY SEED------\n");
  options.credentials_file = folder.path() / "a.creds";
  EXPECT_THAT(faults_of_security_files(options), IsEmpty());
}

TEST(NatsSecurityFiles, EachFaultNamesItsFile) {
  const TestCertificates certificates;
  const TemporaryFolder folder;
  const std::string broken = folder.path() / "broken.pem";
  folder.write("broken.pem", "-----BEGIN CERTIFICATE-----\nAAAA\n-----END CERTIFICATE-----\n");
  ConnectOptions options;
  options.credentials_file = certificates.ca();
  options.ca_file = broken;
  options.certificate_file = certificates.client();
  options.key_file = certificates.server_key();
  EXPECT_THAT(
      faults_of_security_files(options),
      ElementsAre(fault(File::kCredentials, "ca.pem is no file of credentials"),
                  fault(File::kCa, "broken.pem has no certificate in PEM"),
                  fault(File::kKey, "server.key is not the key of " + certificates.client())));
  options = {};
  options.certificate_file = broken;
  options.key_file = folder.path();
  EXPECT_THAT(faults_of_security_files(options),
              ElementsAre(fault(File::kCertificate, "no certificate in PEM that can be read"),
                          fault(File::kKey, "cannot be read: Is a directory")));
}

TEST(NatsSecurityFiles, CertificatesHaveToHoldNow) {
  const TestCertificates certificates;
  ConnectOptions options;
  options.ca_file = certificates.valid_for_days(-1);
  options.certificate_file = certificates.valid_for_days(-1);
  options.key_file = certificates.client_key();
  EXPECT_THAT(
      faults_of_security_files(options),
      ElementsAre(fault(File::kCa, "has expired"), fault(File::kCertificate, "has expired")));
  options = {};
  const TemporaryFolder folder;
  options.ca_file = folder.write(
      "both.pem", text_of(certificates.valid_for_days(-1)) + text_of(certificates.ca()));
  EXPECT_THAT(faults_of_security_files(options), IsEmpty());
}

TEST(NatsSecurityFiles, AnEncryptedKeyIsRefusedAndAsksNobody) {
  const TestCertificates certificates;
  ConnectOptions options;
  options.certificate_file = certificates.client();
  options.key_file = certificates.encrypted_client_key();
  EXPECT_THAT(faults_of_security_files(options),
              ElementsAre(fault(File::kKey, "is encrypted, which is not supported")));
}

}  // namespace
}  // namespace camway::nats
