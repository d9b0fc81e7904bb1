#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Completes the staged files of each package as Debian wants them: copyright, changelog, the configuration
in /etc, compressed pages of the manual, modes and times. CPack calls it, see stage_debian.cmake.in.

    stage_debian.py --staging DIR --build DIR --version V --maintainer M COMPONENT=PACKAGE...

Each component is staged in DIR/COMPONENT. Files get the time SOURCE_DATE_EPOCH where the environment has it.
"""

import argparse
import gzip
import os
import pathlib
import shutil
import subprocess
import sys
import time
from email.utils import formatdate

HERE = pathlib.Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent


def compress(path):
    """Replaces a file by FILE.gz, whose bytes depend on nothing but its content."""
    with open(f"{path}.gz", "wb") as out, gzip.GzipFile("", "wb", 9, out, mtime=0) as packed:
        packed.write(path.read_bytes())
    path.unlink()


def packed_time():
    """The time of the packages in seconds since 1970: that of the sources, or now."""
    return int(os.environ.get("SOURCE_DATE_EPOCH", time.time()))


def changelog(package, version, maintainer):
    """Writes the changelog that Debian wants, which refers to CHANGELOG.md."""
    return (f"{package} ({version}) unstable; urgency=medium\n\n"
            f"  * Packages of Camway {version.split('-')[0]}. CHANGELOG.md in camway-doc says what changed.\n\n"
            f" -- {maintainer}  {formatdate(packed_time())}\n")


def add_documents(root, package, version, maintainer):
    folder = root / "usr/share/doc" / package
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(HERE / "debian/copyright", folder / "copyright")
    log = folder / "changelog.Debian"
    log.write_text(changelog(package, version, maintainer))
    compress(log)


def stage_daemon(root):
    """Installs the sample as the configuration, until somebody edits it."""
    configuration = root / "etc/camway/camwayd.toml"
    configuration.parent.mkdir(parents=True)
    shutil.copy(root / "usr/share/camway/camwayd.toml", configuration)


def add_sbom(root, options):
    """Puts the bill of materials of all packages into the one that all others need."""
    made = options.build / "build.ninja"
    if not made.exists():
        return  # only Ninja knows which headers a program is made of
    programs = [f"{package}={','.join(files)}" for package, files in programs_of(options).items()]
    subprocess.run([sys.executable, "-B", HERE / "sbom.py", "--build", options.build, "--version", options.version,
                    "--out", root / "usr/share/doc/camway/sbom.spdx.json", *programs], check=True)


def programs_of(options):
    """The programs and shared libraries of each package, as the build has them."""
    programs = {}
    for pair in options.packages:
        component, package = pair.split("=")
        staged = options.staging / component / "usr"
        names = [path.name for path in [*staged.glob("bin/*"), *staged.glob("lib/**/*.so.*")] if not path.is_symlink()]
        built = [os.path.join(folder, name) for name in sorted(names) for folder in ("bin", ".")
                 if (options.build / folder / name).is_file()]
        if built:
            programs[package] = [os.path.normpath(file) for file in built]
    return programs


def stage_client(root):
    """Strips the files that CPack does not, since nobody debugs the library without its sources."""
    for archive in sorted(root.rglob("*.a")):
        subprocess.run(["strip", "--strip-debug", "--enable-deterministic-archives", archive], check=True)


STAGES = {"daemon": stage_daemon, "client": stage_client}


def is_program(path, root):
    """Returns whether a file is a program, a shared object, or a script with an interpreter."""
    head = path.read_bytes()[:4]
    return path.relative_to(root).parts[:2] == ("usr", "bin") or (head[:2] == b"#!" and path.stat().st_mode & 0o100)


def settle(root):
    """Sets modes and times that do not depend on the user and the time of the build."""
    when = packed_time()
    for path in [root, *root.rglob("*")]:
        if path.is_symlink():
            continue
        path.chmod(0o755 if path.is_dir() or is_program(path, root) else 0o644)
    for path in [*root.rglob("*"), root]:
        os.utime(path, (when, when), follow_symlinks=False)


def stage(root, component, package, options):
    STAGES.get(component, lambda root: None)(root)
    # zsh looks for completions of packages in a folder of its own.
    completions = root / "usr/share/zsh/site-functions"
    if completions.is_dir():
        completions.rename(completions.parent / "vendor-completions")
    for page in sorted(root.glob("usr/share/man/man*/*")):
        if page.suffix != ".gz":
            compress(page)
    add_documents(root, package, options.version, options.maintainer)
    if component == "tools":
        add_sbom(root, options)
    settle(root)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--staging", type=pathlib.Path, required=True)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--version", required=True)
    parser.add_argument("--maintainer", required=True)
    parser.add_argument("packages", nargs="+")
    options = parser.parse_args()
    for pair in options.packages:
        component, package = pair.split("=")
        root = options.staging / component
        if root.is_dir():
            stage(root, component, package, options)


if __name__ == "__main__":
    main()
