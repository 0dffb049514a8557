# Writes OUTPUT, a source file that returns the text of INPUT as std::string_view. Chunks stay below
# the 64 KiB that every compiler accepts in one literal.
file(READ ${INPUT} text)
string(LENGTH "${text}" length)
set(pieces "")
set(at 0)
while(at LESS length)
  string(SUBSTRING "${text}" ${at} 8000 piece)
  string(APPEND pieces "R\"embedded(${piece})embedded\"\n")
  math(EXPR at "${at} + 8000")
endwhile()
file(WRITE ${OUTPUT} "#include <string_view>

namespace simwright::${NAMESPACE}::data {

std::string_view ${IDENTIFIER}() {
  static constexpr char kText[] = ${pieces};
  return {kText, sizeof(kText) - 1};
}

}  // namespace simwright::${NAMESPACE}::data
")
