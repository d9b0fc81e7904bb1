// SPDX-License-Identifier: MIT
#include "daemon/nats/security_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  EXPECT_THAT(faults_of_security_files(options),
              ElementsAre(fault(File::kCredentials, "ca.pem is no file of credentials"),
                          fault(File::kCa, "broken.pem has no certificate that can be read"),
                          fault(File::kKey, "not the key of " + certificates.client())));
  options = {};
  options.certificate_file = broken;
  options.key_file = folder.path();
  EXPECT_THAT(faults_of_security_files(options),
              ElementsAre(fault(File::kCertificate, "no certificate that can be read"),
                          fault(File::kKey, "cannot be read: Is a directory")));
}

}  // namespace
}  // namespace camway::nats
