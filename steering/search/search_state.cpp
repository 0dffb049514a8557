#include "steering/search/search_state.h"

#include <optional>

#include "core/error.h"
#include "core/file_seal.h"
#include "core/hdf5.h"
#include "core/json.h"

namespace simwright::steering {
namespace fs = std::filesystem;
namespace {

constexpr char kSearchFormat[] = "simwright scene search";
constexpr std::int64_t kSearchVersion = 1;
constexpr std::size_t kLinks = 3;  // integers per node: parent, visits, terminal

// Returns the first member in which two JSON objects differ, as ": steps was 4 and is now 5"; empty
// if either is no object.
std::string Difference(const std::string& before, const std::string& now) {
  const std::optional<core::Json> earlier = core::TryParseJson(before);
  const std::optional<core::Json> wanted = core::TryParseJson(now);
  if (!earlier || !wanted || !earlier->is_object() || !wanted->is_object()) return "";
  for (const auto& [name, value] : wanted->items()) {
    const auto found = earlier->find(name);
    if (found != earlier->end() && *found == value) continue;
    const std::string was = found == earlier->end() ? "absent" : core::JsonLine(*found);
    return ": " + name + " was " + was + " and is now " + core::JsonLine(value);
  }
  return "";
}

void WriteTree(const SearchState& state, core::Hdf5Group* root) {
  std::vector<std::int64_t> links;
  std::vector<double> rewards;
  for (const TreeNode& node : state.nodes) {
    links.insert(links.end(), {node.parent, node.visits, node.terminal});
    rewards.insert(rewards.end(), {node.reward, node.total});
  }
  root->Write("node_links", {state.nodes.size(), kLinks}, links.data());
  root->Write("node_rewards", {state.nodes.size(), 2}, rewards.data());
}

void WriteScenes(const SearchState& state, const scene::Vocabulary& vocabulary,
                 core::Hdf5Group* root) {
  const auto entries = static_cast<std::size_t>(vocabulary.entries);
  std::vector<float> tokens;
  std::vector<std::uint8_t> flags;  // 1: penetrating, 2: unstable
  for (const TokenScene& scene : state.scenes) {
    tokens.insert(tokens.end(), scene.tokens.begin(), scene.tokens.end());
    for (std::size_t i = 0; i < entries; ++i) {
      flags.push_back(
          static_cast<std::uint8_t>((scene.penetrating[i] ? 1 : 0) + (scene.unstable[i] ? 2 : 0)));
    }
  }
  root->Write("tokens",
              {state.scenes.size(), entries, static_cast<std::size_t>(vocabulary.TokenWidth())},
              tokens.data());
  root->Write("flags", {state.scenes.size(), entries}, flags.data());
}

void WriteRecords(const SearchState& state, core::Hdf5Group* root) {
  std::vector<std::int64_t> counts;
  std::vector<double> rewards;
  for (const SearchRecord& one : state.records) {
    counts.insert(counts.end(), {one.nodes, one.samples});
    rewards.insert(rewards.end(), {one.best, one.reward});
  }
  root->SetAttribute("iterations", static_cast<std::int64_t>(state.records.size()));
  if (state.records.empty()) return;
  root->Write("iteration_counts", {state.records.size(), 2}, counts.data());
  root->Write("iteration_rewards", {state.records.size(), 2}, rewards.data());
}

// Reads a dataset whose shape must be this one.
template <typename T>
std::vector<T> ReadOfShape(const core::Hdf5Group& root, const std::string& name,
                           const std::vector<std::size_t>& shape) {
  if (root.Shape(name) != shape) throw core::Error("the search has a dataset of wrong size", name);
  return root.Read<T>(name).values;
}

void ReadTree(const core::Hdf5Group& root, std::size_t count, SearchState* state) {
  const auto links = ReadOfShape<std::int64_t>(root, "node_links", {count, kLinks});
  const auto rewards = ReadOfShape<double>(root, "node_rewards", {count, 2});
  for (std::size_t i = 0; i < count; ++i) {
    TreeNode node;
    node.parent = static_cast<int>(links[kLinks * i]);
    node.visits = static_cast<int>(links[kLinks * i + 1]);
    node.terminal = links[kLinks * i + 2] != 0;
    node.reward = rewards[2 * i];
    node.total = rewards[2 * i + 1];
    state->nodes.push_back(node);
  }
}

void ReadScenes(const core::Hdf5Group& root, std::size_t count, const scene::Vocabulary& vocabulary,
                SearchState* state) {
  const auto entries = static_cast<std::size_t>(vocabulary.entries);
  const std::size_t size = entries * static_cast<std::size_t>(vocabulary.TokenWidth());
  const auto tokens = ReadOfShape<float>(
      root, "tokens", {count, entries, static_cast<std::size_t>(vocabulary.TokenWidth())});
  const auto flags = ReadOfShape<std::uint8_t>(root, "flags", {count, entries});
  for (std::size_t i = 0; i < count; ++i) {
    TokenScene scene = TokenScene::Empty(vocabulary);
    std::copy_n(&tokens[i * size], size, scene.tokens.begin());
    for (std::size_t e = 0; e < entries; ++e) {
      scene.penetrating[e] = flags[i * entries + e] & 1;
      scene.unstable[e] = (flags[i * entries + e] & 2) != 0;
    }
    state->scenes.push_back(std::move(scene));
  }
}

void ReadRecords(const core::Hdf5Group& root, SearchState* state) {
  const auto count = static_cast<std::size_t>(root.IntegerAttribute("iterations"));
  if (count == 0) return;
  const auto counts = ReadOfShape<std::int64_t>(root, "iteration_counts", {count, 2});
  const auto rewards = ReadOfShape<double>(root, "iteration_rewards", {count, 2});
  for (std::size_t i = 0; i < count; ++i) {
    state->records.push_back({rewards[2 * i], rewards[2 * i + 1], static_cast<int>(counts[2 * i]),
                              static_cast<int>(counts[2 * i + 1])});
  }
}

}  // namespace

void WriteSearchState(const SearchState& state, const scene::Vocabulary& vocabulary,
                      const std::string& settings, const fs::path& path) {
  core::Hdf5Writer writer(path);
  core::Hdf5Group& root = writer.root();
  root.SetAttribute("format", kSearchFormat);
  root.SetAttribute("version", kSearchVersion);
  root.SetAttribute("settings", settings);
  root.SetAttribute("best", static_cast<std::int64_t>(state.best));
  root.SetAttribute("samples", static_cast<std::int64_t>(state.samples));
  root.Write("best_reward", {1}, &state.best_reward);
  WriteTree(state, &root);
  WriteScenes(state, vocabulary, &root);
  WriteRecords(state, &root);
  writer.CommitSealed();
}

SearchState ReadSearchState(const fs::path& path, const scene::Vocabulary& vocabulary,
                            const std::string& settings) {
  if (!fs::is_regular_file(path)) {
    throw core::Error("there is no search to resume", path.string(), "start it without --resume");
  }
  if (core::CheckSeal(path) != core::FileSeal::kHolds) {
    throw core::Error("the state of the search is damaged", path.string(),
                      "start it without --resume");
  }
  const core::Hdf5Reader reader(path);
  const core::Hdf5Group& root = reader.root();
  if (root.TextAttribute("format") != kSearchFormat ||
      root.IntegerAttribute("version") != kSearchVersion) {
    throw core::Error("this is not the state of a search of this version", path.string());
  }
  if (const std::string before = root.TextAttribute("settings"); before != settings) {
    throw core::Error("the search was started with other settings" + Difference(before, settings),
                      path.string(), "resume it with the same options");
  }
  SearchState state;
  state.best = static_cast<int>(root.IntegerAttribute("best"));
  state.samples = static_cast<int>(root.IntegerAttribute("samples"));
  state.best_reward = ReadOfShape<double>(root, "best_reward", {1}).front();
  const std::size_t count = root.Shape("node_links").front();
  ReadTree(root, count, &state);
  ReadScenes(root, count, vocabulary, &state);
  ReadRecords(root, &state);
  return state;
}

}  // namespace simwright::steering
