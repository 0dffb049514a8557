#!/usr/bin/env bash
# Writes what the Debian package has beside the program's own files: package_files.sh PROGRAM SOURCE
# OUT. Manual pages are made by help2man from --help, one for each command, as git has them
# (simwright-scene-generate); completions by `simwright completion`; the changelog, and copyright as
# Debian's policy wants it.
set -euo pipefail
program=$1 source=$2 out=$3
rm -rf "$out"
manuals=$out/share/man/man1
doc=$out/share/doc/simwright
mkdir -p "$manuals" "$doc" "$out"/share/{bash-completion/completions,zsh/vendor-completions,fish/vendor_completions.d}

version=$("$program" --version | sed -n 1p)
help=$(mktemp -d)
trap 'rm -rf "$help"' EXIT

# manual COMMAND...: the page of `simwright COMMAND...` and those of its subcommands. help2man runs
# a program that prints the help, in place of one that starts in half a second.
manual() {
  local name=simwright${*:+-$*} subcommand
  name=${name// /-}
  "$program" "$@" --help >"$help/$name.txt"
  printf '#!/bin/sh\ncat "%s"\n' "$help/$name.txt" >"$help/$name"
  chmod +x "$help/$name"
  help2man --no-info --no-discard-stderr --version-string "$version" \
    --name "$(sed -n '1s/^./\L&/p' "$help/$name.txt")" "$help/$name" |
    sed -e "s/^\.TH [A-Z]* /.TH ${name^^} /" -e "s/^simwright \\\\- /$name \\\\- /" |
    gzip -9n >"$manuals/$name.1.gz"
  for subcommand in $(sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z0-9_-]*\) .*/\1/p' "$help/$name.txt"); do
    manual "$@" "$subcommand"
  done
}
manual

"$program" completion --shell bash >"$out/share/bash-completion/completions/simwright"
"$program" completion --shell zsh >"$out/share/zsh/vendor-completions/_simwright"
"$program" completion --shell fish >"$out/share/fish/vendor_completions.d/simwright.fish"

gzip -9nc "$source/CHANGELOG.md" >"$doc/CHANGELOG.md.gz"
{
  echo "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/"
  echo "Upstream-Name: simwright"
  echo
  echo "Files: *"
  echo "Copyright: The Simwright developers"
  echo "License: Apache-2.0"
  echo " The full text is in /usr/share/common-licenses/Apache-2.0. A program linked with CGAL's mesh"
  echo " processing, as simwright is, is under GPL-3 as a whole: /usr/share/common-licenses/GPL-3."
  for license in "$source"/third_party/*/LICENSE; do
    echo
    echo "Files: third_party/$(basename "$(dirname "$license")")/*"
    echo "Copyright: see the licence"
    echo "License: $(basename "$(dirname "$license")")"
    sed -e 's/^[[:space:]]*$/./' -e 's/^/ /' "$license"
  done
} >"$doc/copyright"
