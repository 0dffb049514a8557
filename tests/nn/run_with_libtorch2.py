"""Builds modules of networks and their tests against libtorch 2.x and runs them.

    run_with_libtorch2.py BUILD_FOLDER [--program NAME] [--keep FOLDER] [test argument...]

The program is nn_test, or another test program of PROGRAMS. BUILD_FOLDER has it and
compile_commands.json: its objects that do not include libtorch are linked as they are. Headers and
libraries are those of this Python's torch package, with its libraries of CUDA where it has them.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

import torch

from compile_with_libtorch2 import TORCH_HEADER, Sources, command_against

LIBRARIES = pathlib.Path(torch.__file__).parent / "lib"
# The objects that are compiled again for a program, by the beginning of their path.
PROGRAMS = {
    "nn_test": ("nn/", "tests/nn/CMakeFiles/nn_test"),
    "bench_training_speed": ("nn/", "scene/", "bench/scene/CMakeFiles/bench_training_speed"),
    "scene_slow_test": ("nn/", "scene/", "tests/scene/CMakeFiles/scene_slow_test"),
}


def output_of(entry):
    words = entry["command"].split()
    return words[words.index("-o") + 1]


def entries_of(build, root, program):
    """Returns the compilations of a program that include libtorch; first one of nn/."""
    sources = Sources(root)
    entries = []
    for entry in json.loads((build / "compile_commands.json").read_text()):
        path = pathlib.Path(entry["file"])
        wanted = output_of(entry).startswith(PROGRAMS[program]) and "cmake_pch" not in path.name
        if wanted and sources.include_torch(path):
            entries.append(entry)
    return sorted(entries, key=lambda entry: not output_of(entry).startswith("nn/"))


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


def link_command(build, name, entries, objects, program):
    """Returns the link command of a program with other objects and another libtorch."""
    made = subprocess.run(["ninja", "-C", str(build), "-t", "commands", f"bin/{name}"], check=True,
                          capture_output=True, text=True).stdout.splitlines()[-1]
    kept = [word for word in made.split()
            if word.endswith((".so", ".a", ".o")) or ".so." in word or word.startswith("-Wl,-rpath")]
    again = {output_of(entry) for entry in entries}
    other = ("libtorch", "libc10", "openblas", "protobuf", "glog", "gflags")
    kept = [word for word in kept
            if word not in again and not any(name in word for name in other)]
    names = ["libtorch_cpu.so", "libc10.so", "libtorch_cuda.so", "libc10_cuda.so"]
    libraries = [str(LIBRARIES / name) for name in names if (LIBRARIES / name).exists()]
    for cudart in sorted(LIBRARIES.parent.parent.glob("nvidia/*/lib/libcudart.so.*")):
        libraries += [str(cudart), f"-Wl,-rpath,{cudart.parent}"]
    return (["c++", *map(str, objects), "-o", str(program), "-Wl,--allow-shlib-undefined",
             "-Wl,--gc-sections", f"-Wl,-rpath,{LIBRARIES}", "-Wl,--no-as-needed", *libraries,
             "-Wl,--as-needed"] + kept + libraries + ["-lpthread", "-ldl"])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--program", choices=PROGRAMS, default="nn_test")
    parser.add_argument("--keep", type=pathlib.Path, help="a folder for the program")
    options, arguments = parser.parse_known_args()
    build = options.build.resolve()
    if int(torch.__version__.split(".")[0]) < 2:
        sys.exit(f"error: {torch.__version__} is not libtorch 2.x")
    entries = entries_of(build, pathlib.Path(__file__).resolve().parents[2], options.program)
    if len(entries) < 2:
        sys.exit("error: no source that includes libtorch is compiled in this folder")
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        program = folder / f"{options.program}_libtorch2"
        objects = compile_all(entries, folder)
        link = link_command(build, options.program, entries, objects, program)
        subprocess.run(link, check=True, cwd=build)
        done = subprocess.run([str(program), *arguments])
    print(f"{options.program} with libtorch {torch.__version__}: exit code {done.returncode}")
    sys.exit(1 if done.returncode else 0)


if __name__ == "__main__":
    main()
