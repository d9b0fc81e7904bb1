#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes a bill of materials (SPDX 2.3, JSON) of the built programs, from their real parts: the
shared libraries that the loader finds, the static libraries and the headers that the build read, and the packages
of npm in the page of `camway view`.

    sbom.py --build DIR --version V --out FILE PACKAGE=FILE[,FILE...]...

DIR is a build by Ninja, which knows the headers. Debian's packages are named with the versions installed here.
The document has the time SOURCE_DATE_EPOCH where the environment has it.
"""

import argparse
import collections
import datetime
import json
import os
import pathlib
import re
import subprocess
import time
import uuid

from licences import LICENCES

_NAMESPACE = uuid.UUID("5f0c7c1e-3c0b-5b7e-9a39-2f6f1d6f5a10")  # any constant one, for names that do not change


def output(*command, cwd=None, check=True):
    return subprocess.run(command, check=check, text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                          cwd=cwd).stdout


def needed(program):
    """Names of the shared libraries that a program names itself."""
    return set(re.findall(r"\(NEEDED\).*\[(.*)\]", output("readelf", "-d", program)))


def loaded(program):
    """Name and file of each shared library that the loader finds for a program."""
    return dict(re.findall(r"(\S+) => (/\S+)", output("ldd", program)))


def linked(build, target):
    """The files that a target is linked of, and its libraries in turn; files that must only exist first are none."""
    found, ahead = set(), {target}
    while ahead:
        found |= ahead
        said = re.sub(r"(?m)^  outputs:\n(?:    .*\n)*", "", output("ninja", "-t", "query", *sorted(ahead), cwd=build))
        inputs = re.findall(r"^    (?:\| )?([^|\s]\S*\.(?:o|a))$", said, re.MULTILINE)
        ahead = {name for name in inputs if name not in found and name.endswith(".a") and not name.startswith("/")}
        found |= {name for name in inputs if name not in ahead}
    return found


def compiled(build, program):
    """Static libraries and headers of others that a program is made of."""
    files = linked(build, os.path.relpath(program, build))
    objects = sorted(name for name in files if name.endswith(".o"))
    archives = {name for name in files if name.endswith(".a") and name.startswith("/")}
    headers = set(re.findall(r"^    (/usr/\S+)$", output("ninja", "-t", "deps", *objects, cwd=build), re.MULTILINE))
    return archives | headers


def owners(files):
    """The Debian package of each file that has one."""
    # Before the merge of /lib and /usr/lib, packages named files by either.
    names = {}
    for file in files:
        for name in {file, os.path.realpath(file)}:
            for alias in (name, re.sub("^/lib/", "/usr/lib/", name), re.sub("^/usr/lib/", "/lib/", name)):
                names[alias] = file
    found = {}
    for line in output("dpkg", "-S", *sorted(names), check=False).splitlines():
        packages, _, name = line.partition(": ")
        if name in names:
            found[names[name]] = packages.split(", ")[0].split(":")[0]
    return found


def debian_package(name):
    """The entry of a Debian package."""
    form = "${Version}\t${source:Package}\t${source:Version}\t${Architecture}\n"
    fields = output("dpkg-query", "-W", "-f", form, name).split("\n")[0].split("\t")
    version, source, source_version, architecture = fields
    return entry(f"deb-{name}", name, version, LICENCES.get(source, "NOASSERTION"),
                 f"pkg:deb/debian/{name}@{version}?arch={architecture}",
                 f"built from the Debian source package {source} {source_version}")


def entry(key, name, version, licence, purl, comment=None):
    package = {
        "SPDXID": "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", key), "name": name, "versionInfo": version,
        "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "licenseConcluded": "NOASSERTION",
        "licenseDeclared": licence, "copyrightText": "NOASSERTION",
        "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                          "referenceLocator": purl.replace("+", "%2B")}],
    }
    return {**package, "comment": comment} if comment else package


class Document:
    """Packages and relations, each once."""

    def __init__(self):
        self.packages = {}
        self.relations = set()

    def add(self, package):
        self.packages.setdefault(package["SPDXID"], package)
        return package["SPDXID"]

    def relate(self, this, kind, other):
        self.relations.add((this, kind, other))


def add_program(document, key, program, build):
    direct, files = needed(program), loaded(program)
    packages = owners(files.values())
    for name, file in files.items():
        if file in packages:
            other = document.add(debian_package(packages[file]))
            document.relate(key, "DYNAMIC_LINK" if name in direct else "DEPENDS_ON", other)
    for package in set(owners(compiled(build, program)).values()):
        document.relate(key, "STATIC_LINK", document.add(debian_package(package)))


def add_page(document, key, build):
    for part in json.loads((build / "tools/view/page/embed/made/parts.json").read_text()):
        name, version = part["name"], part["version"]
        purl = f"pkg:npm/{name.replace('@', '%40')}@{version}"
        document.relate(key, "CONTAINS", document.add(entry(f"npm-{name}", name, version, part["license"], purl)))


def written(document, version):
    """The document as SPDX wants it."""
    seconds = int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))
    created = datetime.datetime.fromtimestamp(seconds, datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
    packages = [document.packages[key] for key in sorted(document.packages)]
    relations = [{"spdxElementId": this, "relationshipType": kind, "relatedSpdxElement": other}
                 for this, kind, other in sorted(document.relations)]
    content = json.dumps([packages, relations, created])
    return {
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"camway-{version}",
        "documentNamespace": f"urn:uuid:{uuid.uuid5(_NAMESPACE, content)}",
        "creationInfo": {"created": created, "creators": ["Organization: The Camway authors", "Tool: camway-sbom"]},
        "packages": packages, "relationships": relations,
    }


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--version", required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("packages", nargs="+")
    options = parser.parse_args()
    document = Document()
    programs = collections.defaultdict(list)
    for pair in options.packages:
        name, _, files = pair.partition("=")
        programs[name] += files.split(",")
    for name, files in programs.items():
        key = document.add(entry(name, name, options.version, "MIT", f"pkg:deb/{name}@{options.version}"))
        document.relate("SPDXRef-DOCUMENT", "DESCRIBES", key)
        for file in files:
            add_program(document, key, options.build / file, options.build)
        if name == "camway":
            add_page(document, key, options.build)
    options.out.write_text(json.dumps(written(document, options.version), indent=1) + "\n")


if __name__ == "__main__":
    main()
