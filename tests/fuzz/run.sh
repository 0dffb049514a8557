#!/bin/bash
# tests/fuzz/run.sh [SECONDS=60]: builds the fuzz targets in build-sanitize/ and runs each for that
# long. Exit 1 where one crashes; the input that did it stays in build-sanitize/found/.
set -euo pipefail
seconds=${1:-60}
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
build=$root/build-sanitize
cd "$root"
cmake --preset sanitize > /dev/null
cmake --build --preset sanitize --target fuzz_targets
targets="archive_fuzz image_fuzz mesh_fuzz urdf_fuzz catalogue_fuzz chat_fuzz physics_answer_fuzz
  prompt_fuzz reward_fuzz
  task_answer_fuzz robot_side_file_fuzz trajectory_fuzz grasp_fuzz image_answer_fuzz view_request_fuzz"
mkdir -p "$build/found"
# Small files of each kind, made here so that no binary is kept.
image_seeds=$build/seeds/image_fuzz
catalogue_seeds=$build/seeds/catalogue_fuzz
mesh_seeds=$build/seeds/mesh_fuzz
mkdir -p "$image_seeds" "$catalogue_seeds" "$mesh_seeds"
# A GLB: header, the JSON chunk of the glTF seed, no binary chunk.
json=$(tail -c +2 "$here/seeds/mesh_fuzz/tetrahedron_gltf.txt")
while [ $((${#json} % 4)) -ne 0 ]; do json="$json "; done
uint() { printf "\\x$(printf %02x $(($1 & 255)))\\x$(printf %02x $(($1 >> 8 & 255)))\\0\\0"; }
{ printf 'DglTF\2\0\0\0'; uint $((${#json} + 20)); uint ${#json}; printf 'JSON%s' "$json"; } \
  > "$mesh_seeds/tetrahedron.glb"
printf 'P5 2 2 255\n\1\2\3\4' > "$image_seeds/two.pgm"
printf 'GIF89a\1\0\1\0\200\0\0\0\0\0\377\377\377,\0\0\0\0\1\0\1\0\0\2\2D\1\0;' > "$image_seeds/one.gif"
printf '\211PNG\r\n\032\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\10\0\0\0\0\x3a\x7e\x9b\x55\0\0\0\nIDATx\234c\140\0\0\0\2\0\1\x48\xaf\xa4\x71\0\0\0\0IEND\256B\140\202' > "$image_seeds/one.png"
head -c 4096 "$root/examples/apple.jpg" > "$image_seeds/cut.jpg"
folder=$(mktemp -d)
printf 'id#1=cup\nname#1=Cup\nmodel#1=/cup.obj\nwidth#1=8\ndepth#1=8\nheight#1=9\ncategory#1=Kitchen\n' \
  > "$folder/PluginFurnitureCatalog.properties"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' > "$folder/cup.obj"
if command -v python3 > /dev/null; then
  (cd "$folder" && python3 -m zipfile -c "$catalogue_seeds/cup.sh3f" \
    PluginFurnitureCatalog.properties cup.obj)
  mkdir -p "$build/seeds/archive_fuzz"
  (cd "$folder" && python3 -m zipfile -c "$build/seeds/archive_fuzz/cup.zip" cup.obj)
fi
rm -rf "$folder"
mkdir -p "$build/seeds/reward_fuzz"
cp "$root"/tests/reward/corpus/*.py "$build/seeds/reward_fuzz"
# All at once: most of the time of some goes into files, that of others into decoding. An input has
# a minute: fifteen targets share the cores, and planning where things of a URDF stand takes a
# second.
fuzz() {
  local target=$1 folder
  local seeds=()
  for folder in "$here/seeds/$target" "$build/seeds/$target"; do
    [ -d "$folder" ] && seeds+=("$folder")
  done
  mkdir -p "$build/corpus/$target"
  ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1:quarantine_size_mb=16 \
    "$build/bin/$target" "$build/corpus/$target" "${seeds[@]}" \
    -max_total_time="$seconds" -timeout=60 -rss_limit_mb=3000 -max_len=8192 -print_final_stats=1 \
    -artifact_prefix="$build/found/$target-" > "$build/$target.log" 2>&1
}
declare -A running
for target in $targets; do
  fuzz "$target" &
  running[$target]=$!
done
failed=0
for target in $targets; do
  if wait "${running[$target]}"; then
    runs=$(grep -a number_of_executed_units "$build/$target.log" | grep -oE '[0-9]+$')
    echo "$target: $runs inputs in $seconds s"
  else
    echo "$target: FAILED, see $build/$target.log"
    grep -aE "SUMMARY|ERROR" "$build/$target.log" || true
    failed=1
  fi
done
exit $failed
