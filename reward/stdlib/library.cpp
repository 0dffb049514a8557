#include "reward/stdlib/library.h"

#include <algorithm>
#include <set>
#include <unordered_map>

namespace simwright::reward {
namespace {

struct Index {
  std::unordered_map<std::string, const LibraryFunction*> functions;
  std::set<std::string> modules;
};

void AddLibraryNames(const LibraryFunction& function, Index* index) {
  std::string_view rest = function.names;
  while (!rest.empty()) {
    const std::size_t blank = rest.find(' ');
    const std::string name(rest.substr(0, blank));
    index->functions.emplace(name, &function);
    for (std::size_t dot = name.find('.'); dot != std::string::npos;
         dot = name.find('.', dot + 1)) {
      index->modules.insert(name.substr(0, dot));
    }
    rest = blank == std::string_view::npos ? "" : rest.substr(blank + 1);
  }
}

const Index& TheIndex() {
  static const Index* index = [] {
    auto* made = new Index;
    for (const LibraryPart& part :
         {ElementwiseFunctions(), ReductionFunctions(), CreationFunctions(), ShapeFunctions(),
          ProductFunctions(), RotationFunctions(), PythonFunctions(), StringFunctions(),
          OrderFunctions(), ActivationFunctions(), LossFunctions()}) {
      for (std::size_t i = 0; i < part.count; ++i) AddLibraryNames(part.functions[i], made);
    }
    made->modules.insert({"torch.jit", "typing", "numpy.typing"});
    made->modules.erase("Tensor");
    return made;
  }();
  return *index;
}

}  // namespace

const LibraryFunction* FindLibraryFunction(const std::string& name) {
  const auto found = TheIndex().functions.find(name);
  return found == TheIndex().functions.end() ? nullptr : found->second;
}

bool IsLibraryModule(const std::string& module) {
  return TheIndex().modules.contains(module);
}

std::vector<std::string> LibraryNames(const std::string& prefix) {
  std::vector<std::string> names;
  for (const auto& [name, function] : TheIndex().functions) {
    if (!name.starts_with(prefix)) continue;
    const std::string rest = name.substr(prefix.size());
    if (rest.find('.') == std::string::npos) names.push_back(rest);
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace simwright::reward
