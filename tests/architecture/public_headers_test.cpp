// The faces of the modules: simwright_public_headers in a module's CMakeLists.txt lists the headers
// that users include, simwright_shared_headers those that only other modules may include.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "tests/architecture/include_lines.h"

namespace simwright {
namespace {

// Returns the headers that `function` lists in a module's CMakeLists.txt, with the module's name:
// "core/error.h".
std::set<std::string> ListedHeaders(const std::string& module, const std::string& function) {
  std::ifstream in(std::filesystem::path(SIMWRIGHT_SOURCE_DIR) / module / "CMakeLists.txt");
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  std::set<std::string> headers;
  std::smatch call;
  if (!std::regex_search(text, call, std::regex(function + "\\(([^)]*)\\)"))) return headers;
  std::istringstream names(call[1]);
  for (std::string name; names >> name;) {
    EXPECT_TRUE(headers.insert(module + "/" + name).second)
        << module << " lists " << name << " twice";
  }
  return headers;
}

std::set<std::string> ListedHeaders(const std::string& function) {
  std::set<std::string> headers;
  for (const auto& [module, floor] : kFloor) headers.merge(ListedHeaders(module, function));
  return headers;
}

std::set<std::string> PublicHeaders() {
  return ListedHeaders("simwright_public_headers");
}

std::set<std::string> SharedHeaders() {
  return ListedHeaders("simwright_shared_headers");
}

std::string ModuleOf(const std::string& header) {
  const std::size_t slash = header.find('/');
  return slash == std::string::npos ? "" : header.substr(0, slash);
}

TEST(PublicHeaders, ExistAndAreListedOnce) {
  const std::set<std::string> headers = PublicHeaders(), shared = SharedHeaders();
  EXPECT_GT(headers.size(), 100u);
  EXPECT_GT(shared.size(), 50u);
  for (const std::string& header : headers) {
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(SIMWRIGHT_SOURCE_DIR) / header))
        << header;
    EXPECT_FALSE(shared.contains(header)) << header << " is in both lists";
  }
}

TEST(PublicHeaders, IncludeOnlyPublicHeadersEigenAndTheStandardLibrary) {
  const std::set<std::string> headers = PublicHeaders();
  const std::filesystem::path root(SIMWRIGHT_SOURCE_DIR);
  int checked = 0;
  for (const Include& include : AllIncludes()) {
    const std::string file =
        std::filesystem::path(include.file).lexically_relative(root).generic_string();
    if (!headers.contains(file)) continue;
    ++checked;
    const bool standard = include.target.find_first_of("/.") == std::string::npos;
    EXPECT_TRUE(standard || include.target.starts_with("Eigen/") ||
                headers.contains(include.target))
        << file << ":" << include.line << " includes " << include.target;
  }
  EXPECT_GT(checked, 300);
}

TEST(PublicHeaders, OtherModulesIncludeOnlyListedHeaders) {
  const std::set<std::string> headers = PublicHeaders(), shared = SharedHeaders();
  int checked = 0;
  for (const Include& include : AllIncludes()) {
    const std::string other = ModuleOf(include.target);
    if (!kFloor.contains(other) || other == include.module) continue;
    ++checked;
    EXPECT_TRUE(headers.contains(include.target) || shared.contains(include.target))
        << include.file << ":" << include.line << " includes " << include.target << ", which "
        << other << "/CMakeLists.txt does not list";
  }
  EXPECT_GT(checked, 1000);
}

TEST(PublicHeaders, EachSharedHeaderHasAUserInAnotherModule) {
  std::set<std::string> unused = SharedHeaders();
  for (const Include& include : AllIncludes()) {
    if (ModuleOf(include.target) != include.module) unused.erase(include.target);
  }
  for (const std::string& header : unused) ADD_FAILURE() << header;
}

}  // namespace
}  // namespace simwright
