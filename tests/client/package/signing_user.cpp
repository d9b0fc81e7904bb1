// SPDX-License-Identifier: MIT
#include <camway/authentication.h>
#include <camway/client.h>

#include <iostream>

int main(int argc, char** argv) {
  camway::LoadedAuthentication loaded = camway::authentication_from(argc > 1 ? argv[1] : "keys");
  if (!loaded.error.empty()) {
    std::cerr << loaded.error << '\n';
    return 1;
  }
  camway::ClientOptions options;
  options.authentication = loaded.authentication;
  return camway::Client(options).good() ? 0 : 1;
}
