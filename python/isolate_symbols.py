"""Makes the process-wide symbols of shared libraries ordinary ones: isolate_symbols.py FILE...

g++ gives static variables of inline functions and templates the binding STB_GNU_UNIQUE: the dynamic
linker then uses one copy for the whole process, whichever library asks. Two versions of libtorch in
one process, ours and the one that Python imports, would share such variables although their types
differ, and crash. As STB_GLOBAL each library keeps its own, since Python loads modules apart.
"""

import struct
import sys

_SECTION_HEADER_OFFSET = 40  # of a 64-bit little-endian ELF header
_SECTION_COUNTS = 58
_DYNAMIC_SYMBOLS = 11  # SHT_DYNSYM
_SYMBOL_SIZE = 24
_UNIQUE, _GLOBAL = 10, 1


def isolate(path):
    """Changes the file in place; returns the number of changed symbols."""
    with open(path, "rb") as stream:
        content = bytearray(stream.read())
    if content[:6] != b"\x7fELF\x02\x01":
        raise SystemExit(f"error: {path}: is not a 64-bit little-endian ELF file")
    (table,) = struct.unpack_from("<Q", content, _SECTION_HEADER_OFFSET)
    size, count = struct.unpack_from("<HH", content, _SECTION_COUNTS)
    changed = 0
    for section in range(table, table + size * count, size):
        (kind,) = struct.unpack_from("<I", content, section + 4)
        if kind != _DYNAMIC_SYMBOLS:
            continue
        begin, length = struct.unpack_from("<QQ", content, section + 24)
        for symbol in range(begin, begin + length, _SYMBOL_SIZE):
            binding, rest = content[symbol + 4] >> 4, content[symbol + 4] & 15
            if binding == _UNIQUE:
                content[symbol + 4] = _GLOBAL << 4 | rest
                changed += 1
    if changed:
        with open(path, "wb") as stream:
            stream.write(content)
    return changed


if __name__ == "__main__":
    for name in sys.argv[1:]:
        isolate(name)
