# SPDX-License-Identifier: MIT
"""Licences of the Debian source packages that Camway is built of and linked with, in the names of SPDX. A package
that is not here has "NOASSERTION" in the SBOM, and its copyright file says what holds."""

LICENCES = {
    "assimp": "BSD-3-Clause",
    "boost1.74": "BSL-1.0",
    "cairo": "LGPL-2.1-only OR MPL-1.1",
    "cli11": "BSD-3-Clause",
    "coin3": "BSD-3-Clause",
    "eigen3": "MPL-2.0",
    "fmtlib": "MIT",
    "gcc-12": "GPL-3.0-or-later WITH GCC-exception-3.1",
    "glib2.0": "LGPL-2.1-or-later",
    "glibc": "LGPL-2.1-or-later",
    "lcm": "LGPL-2.1-or-later",
    "liblzf": "BSD-2-Clause OR GPL-2.0-or-later",
    "libseccomp": "LGPL-2.1-only",
    "libsodium": "ISC",
    "meshoptimizer": "MIT",
    "nats.c": "Apache-2.0",
    "nlohmann-json3": "MIT",
    "octomap": "BSD-3-Clause",
    "onetbb": "Apache-2.0",
    "opencascade": "LGPL-2.1-only WITH OCCT-exception-1.0",
    "openssl": "Apache-2.0",
    "spdlog": "MIT",
    "sqlite3": "blessing",
    "tomlplusplus": "MIT",
    "xxhash": "BSD-2-Clause",
    "zlib": "Zlib",
}
