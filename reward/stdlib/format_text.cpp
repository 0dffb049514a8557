#include "reward/stdlib/format_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace simwright::reward {
namespace {

constexpr int kWidest = 200;

// The parts of [[fill]align][sign][0][width][,][.precision][kind].
struct Format {
  char fill = ' ';
  char align = '\0';
  char sign = '-';
  int width = 0;
  bool thousands = false;
  int precision = -1;
  char kind = '\0';
};

bool IsAlignment(char c) {
  return c == '<' || c == '>' || c == '^' || c == '=';
}

int TakeNumber(const std::string& text, std::size_t* at) {
  int number = 0;
  while (*at < text.size() && text[*at] >= '0' && text[*at] <= '9') {
    number = std::min(number * 10 + (text[(*at)++] - '0'), 10'000);
  }
  return number;
}

Format ReadFormat(const std::string& text, Position position) {
  Format format;
  std::size_t at = 0;
  if (text.size() > 1 && IsAlignment(text[1])) {
    format.fill = text[0];
    format.align = text[1];
    at = 2;
  } else if (!text.empty() && IsAlignment(text[0])) {
    format.align = text[at++];
  }
  if (at < text.size() && (text[at] == '+' || text[at] == '-' || text[at] == ' ')) {
    format.sign = text[at++];
  }
  if (at < text.size() && text[at] == '0' && format.align == '\0') {
    format.fill = '0';
    format.align = '=';
  }
  format.width = TakeNumber(text, &at);
  if (at < text.size() && (text[at] == ',' || text[at] == '_')) {
    format.thousands = text[at++] == ',';
  }
  if (at < text.size() && text[at] == '.') {
    ++at;
    format.precision = TakeNumber(text, &at);
  }
  if (at < text.size()) format.kind = text[at++];
  const bool known =
      format.kind == '\0' || std::string("dfFeEgG%s").find(format.kind) != std::string::npos;
  if (at != text.size() || !known || format.width > kWidest || format.precision > kWidest) {
    Fail("bad-string", position,
         "the format ':" + text.substr(0, 40) +
             "' is not known here; those such as :.2f, :03d, :>8, :g and :.1% are");
  }
  return format;
}

// Returns a float as Python's repr does: the fewest digits that reproduce it.
std::string ShortestFloat(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value < 0.0 ? "-inf" : "inf";
  char digits[64];
  const double size = std::fabs(value);
  const bool plain = size == 0.0 || (size >= 1e-4 && size < 1e16);
  const auto end = std::to_chars(digits, digits + sizeof digits, value,
                                 plain ? std::chars_format::fixed : std::chars_format::scientific);
  std::string text(digits, end.ptr);
  if (plain && text.find('.') == std::string::npos) text += ".0";
  return text;
}

std::string Printed(char kind, int precision, double value) {
  char text[700];
  const char pattern[] = {'%', '.', '*', kind, '\0'};
  std::snprintf(text, sizeof text, pattern, precision, value);
  return text;
}

// Returns the digits without the sign.
std::string Magnitude(const Value& value, const Format& format, Position position) {
  const double size = std::fabs(value.Number());
  const bool whole = !value.Is(ValueKind::kFloat);
  const int precision = format.precision < 0 ? 6 : format.precision;
  std::string text;
  if (format.kind == 'd' || (format.kind == '\0' && whole && format.precision < 0)) {
    if (!whole) Fail("bad-string", position, "the format 'd' wants a whole number");
    text = std::to_string(value.integer);
    if (text[0] == '-') text.erase(0, 1);
  } else if (format.kind == '%') {
    text = Printed('f', precision, size * 100.0) + "%";
  } else if (format.kind == '\0' && format.precision < 0) {
    text = ShortestFloat(size);
  } else {
    text = Printed(format.kind == '\0' ? 'g' : format.kind, precision, size);
  }
  if (format.thousands) {
    const std::size_t stop = std::min(text.find_first_not_of("0123456789"), text.size());
    for (std::size_t at = stop; at > 3; at -= 3) text.insert(at - 3, ",");
  }
  return text;
}

std::string Padded(const std::string& sign, const std::string& text, const Format& format,
                   char usual) {
  const int missing = format.width - static_cast<int>(sign.size() + text.size());
  if (missing <= 0) return sign + text;
  const char align = format.align == '\0' ? usual : format.align;
  const auto fill = [&](int count) { return std::string(count, format.fill); };
  if (align == '<') return sign + text + fill(missing);
  if (align == '^') return fill(missing / 2) + sign + text + fill(missing - missing / 2);
  return align == '=' ? sign + fill(missing) + text : fill(missing) + sign + text;
}

}  // namespace

std::string FormatValue(const Value& value, const std::string& format, char conversion,
                        Position position) {
  if (conversion != '\0' && conversion != 's' && conversion != 'r') {
    Fail("bad-string", position, "after '!' an r or an s is wanted");
  }
  std::string plain;
  switch (value.kind) {
    case ValueKind::kString:
      plain = conversion == 'r' ? "'" + value.text + "'" : value.text;
      break;
    case ValueKind::kBool:
      plain = value.integer != 0 ? "True" : "False";
      break;
    case ValueKind::kInteger:
      plain = std::to_string(value.integer);
      break;
    case ValueKind::kFloat:
      plain = ShortestFloat(value.number);
      break;
    case ValueKind::kNone:
      plain = "None";
      break;
    case ValueKind::kUndefined:
      Fail(value.text.empty() ? "" : "undefined", position, value.text);
    default:
      Fail("bad-string", position,
           "a string is made of strings and numbers that are known; this is " + Describe(value));
  }
  if (format.empty()) return plain;
  const Format wanted = ReadFormat(format, position);
  if (!value.IsNumber() || conversion != '\0') {
    if ((wanted.kind != '\0' && wanted.kind != 's') || wanted.align == '=') {
      Fail("bad-string", position, "the format ':" + format + "' is one of numbers");
    }
    if (wanted.precision >= 0) plain = plain.substr(0, wanted.precision);
    return Padded("", plain, wanted, '<');
  }
  if (wanted.kind == 's') {
    Fail("bad-string", position, "the format 's' is one of strings, this is " + Describe(value));
  }
  const bool negative = std::signbit(value.Number());
  const std::string sign = negative ? "-" : wanted.sign == '-' ? "" : std::string(1, wanted.sign);
  return Padded(sign, Magnitude(value, wanted, position), wanted, '>');
}

}  // namespace simwright::reward
