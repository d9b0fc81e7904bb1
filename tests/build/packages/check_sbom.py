#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks the structure of a bill of materials by the rules of SPDX 2.3, and that it names the packages that it must.

    check_sbom.py FILE
"""

import json
import re
import sys

_KINDS = {"DESCRIBES", "CONTAINS", "DYNAMIC_LINK", "STATIC_LINK", "DEPENDS_ON"}
_MUST_HAVE = {"camway", "camwayd", "libc6", "liblcm1", "libeigen3-dev", "libstdc++6"}
_OF_THE_PAGE = {"three", "three-mesh-bvh", "camera-controls"}  # none of them in a build without the page


def faults(document):
    for key, value in {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT"}.items():
        if document.get(key) != value:
            yield f"{key} is not {value}"
    if not re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", document["creationInfo"]["created"]):
        yield "creationInfo.created is no time"
    if not all(re.match(r"(Person|Organization|Tool): \S", name) for name in document["creationInfo"]["creators"]):
        yield "creationInfo.creators are no creators"
    if not re.match(r"[a-z]+:\S+$", document["documentNamespace"]):
        yield "documentNamespace is no URI"
    yield from faults_of_packages(document["packages"])
    keys = [package["SPDXID"] for package in document["packages"]]
    for relation in document["relationships"]:
        if relation["relationshipType"] not in _KINDS:
            yield f"unknown relation {relation['relationshipType']}"
        for end in (relation["spdxElementId"], relation["relatedSpdxElement"]):
            if end not in keys and end != "SPDXRef-DOCUMENT":
                yield f"{end} is related, and not there"
    related = {relation["relatedSpdxElement"] for relation in document["relationships"]}
    yield from (f"nothing is related to {key}" for key in keys if key not in related)


def faults_of_packages(packages):
    keys = [package["SPDXID"] for package in packages]
    if len(set(keys)) != len(keys):
        yield "an SPDXID is given twice"
    for package in packages:
        name = package.get("name", "?")
        if not re.fullmatch(r"SPDXRef-[A-Za-z0-9.-]+", package["SPDXID"]):
            yield f"{name}: SPDXID {package['SPDXID']}"
        for key in ("name", "versionInfo", "downloadLocation", "licenseDeclared", "licenseConcluded", "copyrightText"):
            if not package.get(key):
                yield f"{name}: no {key}"
        for reference in package["externalRefs"]:
            if not re.match(r"pkg:(deb|npm)/\S+@\S+$", reference["referenceLocator"]):
                yield f"{name}: {reference['referenceLocator']} is no purl"
    names = {package["name"] for package in packages}
    must_have = _MUST_HAVE | (_OF_THE_PAGE if names & _OF_THE_PAGE else set())
    yield from (f"{name} is missing" for name in sorted(must_have - names))


def main():
    with open(sys.argv[1], encoding="utf8") as file:
        found = list(faults(json.load(file)))
    for fault in found:
        print(f"{sys.argv[1]}: {fault}", file=sys.stderr)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
