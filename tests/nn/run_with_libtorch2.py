"""Builds nn/ and its tests against libtorch 2.x and runs them.

    run_with_libtorch2.py BUILD_FOLDER [--keep FOLDER] [test argument...]

BUILD_FOLDER has compile_commands.json and the built module core. Headers and libraries are those of
this Python's torch package; its libraries of CUDA are linked where it has them.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

import torch

from compile_with_libtorch2 import TORCH_HEADER, command_against

LIBRARIES = pathlib.Path(torch.__file__).parent / "lib"
FOLDERS = ("nn", "tests/nn")


def entries_of(build, root):
    """Returns the compilations of nn/ and its tests, unity files included."""
    entries = []
    for entry in json.loads((build / "compile_commands.json").read_text()):
        path = pathlib.Path(entry["file"])
        base = build if path.is_relative_to(build) else root
        folder = os.path.relpath(path.parent, base)
        wanted = folder in FOLDERS or any(folder.startswith(f"{one}/CMakeFiles/") for one in FOLDERS)
        if wanted and "cmake_pch" not in path.name:
            entries.append(entry)
    return entries


def compile_all(entries, folder):
    """Compiles into `folder` and returns the objects."""
    header = folder / "libtorch2.h"
    header.write_text(f'#include "{TORCH_HEADER}"\n')

    defined = [word for word in command_against(entries[0], header) if word.startswith("-D")]

    def words(entry):
        kept = [word for word in command_against(entry, header) if word != "-fsyntax-only"]
        # The precompiled header wants its own definitions in all commands.
        return kept + [word for word in defined if word not in kept] + ["-O1"]

    precompile = words(entries[0])
    at = precompile.index("-include")
    precompile[at:at + 2] = ["-x", "c++-header", str(header)]
    subprocess.run(precompile, check=True, cwd=entries[0]["directory"])

    def compile_one(i):
        made = folder / f"{i}.o"
        subprocess.run(words(entries[i]) + ["-c", entries[i]["file"], "-o", str(made)], check=True,
                       cwd=entries[i]["directory"])
        return made

    with ThreadPoolExecutor(2) as pool:
        return list(pool.map(compile_one, range(len(entries))))


def link_command(build, objects, program):
    """Returns the link command of nn_test with other objects and another libtorch."""
    made = subprocess.run(["ninja", "-C", str(build), "-t", "commands", "bin/nn_test"], check=True,
                          capture_output=True, text=True).stdout.splitlines()[-1]
    kept = [word for word in made.split()
            if word.endswith((".so", ".a")) or ".so." in word or word.startswith("-Wl,-rpath")]
    other = ("torch", "libc10", "simwright_nn", "openblas", "protobuf", "glog", "gflags")
    kept = [word for word in kept if not any(name in word for name in other)]
    names = ["libtorch_cpu.so", "libc10.so", "libtorch_cuda.so", "libc10_cuda.so"]
    libraries = [str(LIBRARIES / name) for name in names if (LIBRARIES / name).exists()]
    return (["c++", *map(str, objects), "-o", str(program), "-Wl,--allow-shlib-undefined",
             f"-Wl,-rpath,{LIBRARIES}", "-Wl,--no-as-needed", *libraries, "-Wl,--as-needed"]
            + kept + libraries + ["-lpthread", "-ldl"])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--keep", type=pathlib.Path, help="a folder for the program")
    options, arguments = parser.parse_known_args()
    build = options.build.resolve()
    if int(torch.__version__.split(".")[0]) < 2:
        sys.exit(f"error: {torch.__version__} is not libtorch 2.x")
    entries = entries_of(build, pathlib.Path(__file__).resolve().parents[2])
    if len(entries) < 2:
        sys.exit("error: no source of nn/ or its tests is compiled in this folder")
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        program = folder / "nn_test_libtorch2"
        objects = compile_all(entries, folder)
        subprocess.run(link_command(build, objects, program), check=True, cwd=build)
        done = subprocess.run([str(program), *arguments])
    print(f"nn_test with libtorch {torch.__version__}: exit code {done.returncode}")
    sys.exit(1 if done.returncode else 0)


if __name__ == "__main__":
    main()
