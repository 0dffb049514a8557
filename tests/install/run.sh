#!/usr/bin/env bash
# usage: run.sh BUILD SOURCE. Installs BUILD into a fresh prefix, builds the programs of examples/cpp
# against it, and runs each. `read_asset` is built where libtorch, CGAL and Embree cannot be found:
# the component assets needs none of them.
set -euo pipefail
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >/dev/null
configure() {
  cmake -S "$source/examples/cpp" -B "$work/$1" -G Ninja -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_PREFIX_PATH="$work/prefix" "${@:2}" >/dev/null
}
configure assets_alone -DEXAMPLES=read_asset -DCMAKE_DISABLE_FIND_PACKAGE_Torch=ON \
  -DCMAKE_DISABLE_FIND_PACKAGE_CGAL=ON -DCMAKE_DISABLE_FIND_PACKAGE_embree=ON
cmake --build "$work/assets_alone"
configure all
cmake --build "$work/all"
if configure unknown -DEXAMPLES=nothing -Dnothing=nonsense 2>"$work/log"; then
  echo "error: an unknown component was accepted" >&2
  exit 1
fi
"$work/prefix/bin/simwright" lift "$source/examples/orange.jpg" --category orange --quiet \
  -o "$work/orange"
"$work/assets_alone/read_asset" "$work/orange"
"$work/all/read_asset" "$work/orange"
"$work/all/lift_photo" "$source/examples/orange.jpg" "$work/orange.obj"
"$work/all/decompose_solid"
"$work/all/differentiate_render"
"$work/all/compile_reward"
"$work/all/step_environment" "$work/orange"
"$work/all/project_scene"
"$work/all/export_world" "$work/orange" "$work/world.xml"
