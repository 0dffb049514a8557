#!/usr/bin/env bash
# usage: headers.sh BUILD [--alone]. Installs BUILD into a fresh prefix and builds a program per
# component that includes all public headers of the component, once in alphabetical and once in
# reverse order: a public header includes what it needs, which is the standard library, Eigen and
# other public headers. --alone also compiles each header alone, which takes four minutes on two
# cores.
set -euo pipefail
build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >/dev/null
cd "$work/prefix/include"
find simwright -name '*.h' | sort >"$work/headers"
export INCLUDES="-I. -Isimwright $(pkg-config --cflags eigen3 | sed 's/-I/-isystem /g')"
compile_alone() {
  # shellcheck disable=SC2086  # INCLUDES are several options
  echo "#include <$1>" | "${CXX:-c++}" -std=c++20 -Wall -Wextra -Werror -fsyntax-only $INCLUDES \
    -x c++ - || { echo "error: $1 does not compile alone" >&2; return 1; }
}
export -f compile_alone
if [ "${2:-}" = --alone ]; then
  xargs -a "$work/headers" -P "$(nproc)" -I '{}' bash -c 'compile_alone {}'
fi

mkdir "$work/programs"
cd "$work/programs"
components=$(cut -d/ -f2 "$work/headers" | sort -u)
for component in $components; do
  grep "^simwright/$component/" "$work/headers" | sed 's/.*/#include <&>/' >"$component.cpp"
  tac "$component.cpp" >"${component}_reversed.cpp"
  echo "int main() {}" >>"$component.cpp"
done
cat >CMakeLists.txt <<'EOF'
cmake_minimum_required(VERSION 3.25)
project(simwright_components LANGUAGES C CXX)
foreach(component ${COMPONENTS})
  find_package(simwright REQUIRED COMPONENTS ${component})
  add_executable(uses_${component} ${component}.cpp ${component}_reversed.cpp)
  target_link_libraries(uses_${component} PRIVATE simwright::${component})
endforeach()
EOF
cmake -S . -B build -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" \
  -DCOMPONENTS="${components//$'\n'/;}" >/dev/null
cmake --build build
echo "$(wc -l <"$work/headers") headers of $(wc -w <<<"$components") components"
