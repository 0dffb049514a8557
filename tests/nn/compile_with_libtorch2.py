"""Compiles every source that includes libtorch against the headers of libtorch 2.x.

    compile_with_libtorch2.py BUILD_FOLDER [--module NAME]

BUILD_FOLDER has compile_commands.json. The headers are those of this Python's torch package. Sources
are compiled as in the build, without their precompiled headers and without writing code.
"""

import argparse
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

import torch

INCLUDE = re.compile(r'^\s*#include "([^"]+)"', re.M)
HEADERS = pathlib.Path(torch.__file__).parent / "include"
TORCH_HEADER = "nn/torch.h"


def cuda_folders():
    """Returns the include folders of CUDA among Python's packages; none where one is missing."""
    folders = []
    for header in ("cuda_runtime_api.h", "crt/host_config.h"):
        found = [path for root in sys.path for path in
                 sorted(pathlib.Path(root).glob(f"nvidia/*/include/{header}"))]
        if not found:
            return []
        folders.append(str(found[0])[:-len(header) - 1])
    return folders


class Sources:
    """Answers which files of the source folder include libtorch, directly or not."""

    def __init__(self, folder):
        self.folder = folder
        self.known = {}

    def include_torch(self, path):
        if path not in self.known:
            self.known[path] = False  # for files that include each other
            names = INCLUDE.findall(path.read_text(errors="replace")) if path.exists() else []
            self.known[path] = TORCH_HEADER in names or any(
                self.include_torch(self.folder / name) for name in names)
        return self.known[path]


def command_against(entry, header):
    """Returns the command of an entry, with `header` in front of all others."""
    words = shlex.split(entry["command"])
    kept = [words[0], "-fsyntax-only", "-Winvalid-pch", "-include", str(header)]
    for folder in (HEADERS, HEADERS / "torch/csrc/api/include"):
        kept += ["-isystem", str(folder)]
    if torch.version.cuda and cuda_folders():
        kept.append("-DSIMWRIGHT_CUDA_GRAPHS")
        for folder in cuda_folders():
            kept += ["-isystem", folder]
    skip = False
    for i, word in enumerate(words[1:], 1):
        if skip or word in ("-c", "-Winvalid-pch", "-fpch-preprocess", entry["file"]):
            skip = False
            continue
        if word in ("-o", "-include") or (word == "-isystem" and "/torch/" in words[i + 1]):
            skip = True
            continue
        kept.append(word)
    return kept + ["-Wno-error"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--module", help="a folder of the sources")
    options = parser.parse_args()
    options.build = options.build.resolve()
    if int(torch.__version__.split(".")[0]) < 2:
        sys.exit(f"error: {torch.__version__} is not libtorch 2.x")
    commands = json.loads((options.build / "compile_commands.json").read_text())
    root = pathlib.Path(__file__).resolve().parents[2]
    sources = Sources(root)
    entries = []
    for entry in commands:
        where = pathlib.Path(entry["file"])
        if "cmake_pch" in where.name or "libtorch" in where.name:
            continue
        relative = os.path.relpath(where, options.build).split(os.sep)[0]
        if where.is_relative_to(root) and not where.is_relative_to(options.build):
            relative = where.relative_to(root).parts[0]
        if relative in ("tests", "bench") or (options.module and relative != options.module):
            continue
        if sources.include_torch(where):
            entries.append(entry)
    if not entries:
        sys.exit("error: no source includes libtorch")
    with tempfile.TemporaryDirectory() as folder:
        header = pathlib.Path(folder) / "libtorch2.h"
        header.write_text(f'#include "{TORCH_HEADER}"\n')
        precompile = command_against(entries[0], header)
        precompile = [w for w in precompile if w != "-fsyntax-only"]
        at = precompile.index("-include")
        precompile[at:at + 2] = ["-x", "c++-header", str(header)]
        subprocess.run(precompile, check=True, cwd=entries[0]["directory"])

        def compile_one(entry):
            command = command_against(entry, header) + [entry["file"]]
            return subprocess.run(command, cwd=entry["directory"], capture_output=True, text=True)

        with ThreadPoolExecutor(2) as pool:
            results = list(pool.map(compile_one, entries))
    failed = 0
    for entry, result in zip(entries, results):
        warned = re.search(r"warning: .*(deprecated|invalid-pch)", result.stderr)
        if result.returncode != 0 or warned:
            failed += 1
            print(entry["file"], result.stderr[:4000], sep="\n")
    print(f"{len(entries) - failed} of {len(entries)} sources compile with libtorch "
          f"{torch.__version__}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
