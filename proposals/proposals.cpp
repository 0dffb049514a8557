#include "proposals/proposals.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

#include "core/error.h"
#include "core/files.h"
#include "core/finding_json.h"
#include "core/json.h"
#include "core/random.h"
#include "proposals/picture_folder.h"

namespace simwright::proposals {
namespace {
namespace fs = std::filesystem;

constexpr int kFailuresInARow = 3;
constexpr int kSheetSide = 200, kSheetColumns = 8, kFrame = 6;  // pixels
constexpr std::size_t kMostOnSheet = 400;

std::string PictureFile(const std::string& category, int number) {
  std::string name = category;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return "pictures/" + name + "_" + std::to_string(number) + ".png";
}

// Collects the pictures of the proposals into a folder.
class PictureCollector {
 public:
  PictureCollector(const ProposalRequest& request, const fs::path& folder, ProposalReport* report)
      : request_(request), folder_(folder), report_(*report) {
    if (!request.images.empty()) given_ = ReadPictureFolder(request.images);
    fs::create_directories(folder / "pictures");
  }

  // Adds the categories that the folder of pictures has beyond the proposed ones, as long as there
  // is room, and drops proposed ones without a picture if there are too many.
  void AddGivenCategories() {
    const auto is_known = [&](const std::string& category) {
      return std::any_of(report_.proposals.begin(), report_.proposals.end(),
                         [&](const Proposal& p) { return p.category.category == category; });
    };
    std::stable_partition(
        report_.proposals.begin(), report_.proposals.end(),
        [&](const Proposal& p) { return given_.by_category.contains(p.category.category); });
    std::vector<Proposal> added;
    for (const auto& [category, files] : given_.by_category) {
      if (is_known(category)) continue;
      Proposal proposal;
      proposal.category = {category, PromptFor(category), "folder", RowOf(category), 0.0};
      added.push_back(std::move(proposal));
    }
    const auto first_without = std::find_if(
        report_.proposals.begin(), report_.proposals.end(),
        [&](const Proposal& p) { return !given_.by_category.contains(p.category.category); });
    report_.proposals.insert(first_without, added.begin(), added.end());
    const auto room = static_cast<std::size_t>(request_.count);
    if (report_.proposals.size() > room) report_.proposals.resize(room);
    ReportUnused();
  }

  void Collect(Proposal* proposal) {
    if (request_.generator != nullptr) {
      for (int number = 1; number <= request_.pictures; ++number) Fetch(number, proposal);
      return;
    }
    const auto found = given_.by_category.find(proposal->category.category);
    if (found == given_.by_category.end()) return;
    int number = 0;
    for (const fs::path& file : found->second) {
      if (++number > request_.pictures) break;
      ProposedPicture picture;
      picture.source = fs::relative(file, request_.images).generic_string();
      try {
        Keep(core::ReadImage(file), number, proposal, &picture);
      } catch (const core::Error& error) {
        picture.test.reason = error.what();
      }
      proposal->pictures.push_back(std::move(picture));
    }
  }

  // The thumbnails of the contact sheet.
  const std::vector<core::Image>& thumbnails() const { return thumbnails_; }
  int fetched() const { return fetched_; }  // pictures in the folder

 private:
  // Reports what of the folder of pictures is not used.
  void ReportUnused() {
    std::size_t used = 0, surplus = 0;
    for (const Proposal& proposal : report_.proposals) {
      const auto found = given_.by_category.find(proposal.category.category);
      if (found == given_.by_category.end()) continue;
      ++used;
      const auto wanted = static_cast<std::size_t>(request_.pictures);
      surplus += std::max(found->second.size(), wanted) - wanted;
    }
    Report("pictures-unnamed", given_.unnamed,
           " pictures have no category in their name and are not used",
           "name them mug_1.jpg, or put them into a folder mug");
    Report("pictures-folders-unnamed", given_.unnamed_folders,
           " folders have names that are no category, and their pictures are not used",
           "name a folder by its category in one to four English words");
    Report("pictures-categories-left-out", static_cast<int>(given_.by_category.size() - used),
           " categories of the folder are not used, since --count allows no more", "raise --count");
    Report("pictures-left-out", static_cast<int>(surplus),
           " pictures are not used, since --pictures allows no more of a category",
           "raise --pictures");
  }

  // Adds a warning with its count unless `count` is 0.
  void Report(const char* code, int count, const char* sentence, const char* remedy) {
    if (count == 0) return;
    report_.findings.push_back({code, core::Severity::kWarning, request_.images.string(),
                                std::to_string(count) + sentence, static_cast<double>(count),
                                remedy});
  }

  void Fetch(int number, Proposal* proposal) {
    if (failures_ == kFailuresInARow) return;
    ProposedPicture picture;
    picture.source = request_.generator->name();
    texture::ImageRequest request;
    request.prompt = proposal->category.prompt;
    request.negative_prompt = kProposalNegativePrompt;
    request.width = request.height = request_.size;
    core::Rng rng = core::StreamRng(request_.seed, ++asked_);
    request.seed = picture.seed = rng() & 0xffffffffull;
    try {
      Keep(request_.generator->Generate(request), number, proposal, &picture);
      failures_ = 0;
    } catch (const core::Error& error) {
      // Without any picture the fault is the server's or the user's.
      if (fetched_ == 0 && ++failures_ == kFailuresInARow) throw;
      if (fetched_ > 0) ++failures_;
      picture.test.reason = error.what();
      if (failures_ == kFailuresInARow) {
        report_.findings.push_back({"pictures-ended", core::Severity::kWarning,
                                    request_.generator->name(),
                                    "three requests in a row failed, so that no more pictures "
                                    "were asked for: " +
                                        picture.test.reason,
                                    static_cast<double>(fetched_)});
      }
    }
    proposal->pictures.push_back(std::move(picture));
  }

  void Keep(const core::Image& image, int number, Proposal* proposal, ProposedPicture* picture) {
    picture->test = TestUncluttered(image, request_.seed, request_.limits);
    picture->file = PictureFile(proposal->category.category, number);
    core::WritePng(folder_ / picture->file, image);
    ++fetched_;
    if (thumbnails_.size() < kMostOnSheet) AddThumbnail(image, picture->test.kept);
  }

  void AddThumbnail(const core::Image& image, bool kept) {
    const double scale =
        static_cast<double>(kSheetSide - 2 * kFrame) / std::max(image.width, image.height);
    const auto scaled = [&](int side) {
      return std::max(1, static_cast<int>(std::lround(side * scale)));
    };
    const core::Image small = core::Resize(image, scaled(image.width), scaled(image.height));
    core::Image framed(kSheetSide, kSheetSide, 3, 255);
    for (int y = 0; y < kSheetSide; ++y) {
      for (int x = 0; x < kSheetSide; ++x) {
        std::uint8_t* to = framed.At(x, y);
        const bool in_frame = std::min({x, y, kSheetSide - 1 - x, kSheetSide - 1 - y}) < kFrame - 2;
        if (!kept && in_frame) to[1] = to[2] = 40;
        const int u = x - (kSheetSide - small.width) / 2, v = y - (kSheetSide - small.height) / 2;
        if (u < 0 || v < 0 || u >= small.width || v >= small.height) continue;
        const std::uint8_t* from = small.At(u, v);
        for (int c = 0; c < 3; ++c) to[c] = from[small.channels < 3 ? 0 : c];
      }
    }
    thumbnails_.push_back(std::move(framed));
  }

  const ProposalRequest& request_;
  fs::path folder_;
  ProposalReport& report_;
  PictureFolder given_;
  std::vector<core::Image> thumbnails_;
  std::uint64_t asked_ = 0;
  int fetched_ = 0, failures_ = 0;  // failures in a row
};

core::OrderedJson PictureJson(const ProposedPicture& picture) {
  core::OrderedJson json;
  if (!picture.file.empty()) json["picture"] = picture.file;
  json["source"] = picture.source;
  if (picture.seed != 0) json["seed"] = picture.seed;
  json["kept"] = picture.test.kept;
  if (!picture.test.kept) json["reason"] = picture.test.reason;
  json["test"] = {{"object_area", picture.test.area},
                  {"border_contact", picture.test.border},
                  {"second_object", picture.test.second},
                  {"background_unevenness", picture.test.unevenness}};
  return json;
}

// Collects the pictures of all proposals, and the sheet. Returns the message of the error that
// ended the work after the first picture, or ""; without a picture the error is thrown.
std::string CollectPictures(const ProposalRequest& request, const fs::path& folder,
                            ProposalReport* report, core::Progress* progress) {
  PictureCollector collector(request, folder, report);
  std::string fault;
  std::size_t done = 0;
  try {
    if (!request.images.empty()) collector.AddGivenCategories();
    progress->Stage("pictures", static_cast<int>(report->proposals.size()));
    for (Proposal& proposal : report->proposals) {
      collector.Collect(&proposal);
      ++done;
      progress->Advance();
    }
  } catch (const core::Cancelled&) {
    if (collector.fetched() == 0) throw;
    report->interrupted = done < report->proposals.size();
  } catch (const std::exception& error) {
    if (collector.fetched() == 0) throw;
    fault = error.what();
  }
  if (report->interrupted || !fault.empty()) {
    report->findings.push_back({"proposals-stopped", core::Severity::kWarning,
                                report->output.string(),
                                "the work was stopped before all pictures were there" +
                                    (fault.empty() ? "" : ": " + fault),
                                static_cast<double>(collector.fetched())});
  }
  if (request.generator != nullptr) {
    const core::Findings found = request.generator->TakeFindings();
    report->findings.insert(report->findings.end(), found.begin(), found.end());
  }
  if (!collector.thumbnails().empty()) {
    core::WritePng(folder / "sheet.png", core::ContactSheet(collector.thumbnails(), kSheetColumns));
  }
  return fault;
}

int CountPictures(const ProposalReport& report, bool kept) {
  int count = 0;
  for (const Proposal& proposal : report.proposals) {
    for (const ProposedPicture& picture : proposal.pictures) count += picture.test.kept == kept;
  }
  return count;
}

}  // namespace

bool ProposalRequest::IsValid(std::string* error) const {
  std::string fault;
  if (theme.find_first_not_of(" \t") == std::string::npos) fault = "the theme is empty";
  if (theme.size() > 200) fault = "the theme is longer than 200 bytes";
  if (count < 1 || count > 10'000) fault = "the number of categories must lie in 1 to 10000";
  if (pictures < 1 || pictures > 1000) fault = "the number of pictures must lie in 1 to 1000";
  if (size < 64 || size > 4096) fault = "the pictures' size must lie in 64 to 4096 pixels";
  if (generator != nullptr && !images.empty()) {
    fault = "pictures come from a generator or from a folder, not from both";
  }
  if (error != nullptr) *error = fault;
  return fault.empty();
}

int ProposalReport::kept() const {
  return CountPictures(*this, true);
}
int ProposalReport::refused() const {
  return CountPictures(*this, false);
}

ProposalReport Propose(const ProposalRequest& request, core::Progress* progress) {
  std::string fault;
  if (!request.IsValid(&fault)) throw core::Error(fault, "the request for proposals");
  ProposalReport report;
  report.output = request.output;
  core::StagedFolder staged(request.output, request.force);
  progress->Stage("categories");
  const std::vector<CategoryProposal> categories =
      request.model == nullptr ? OfflineCategories(request.theme, request.count, &report.findings)
                               : LanguageModelCategories(request.theme, request.count,
                                                         request.model, &report.findings, progress);
  for (const CategoryProposal& category : categories) report.proposals.push_back({category, {}});
  std::string stopped;
  if (request.generator != nullptr || !request.images.empty()) {
    stopped = CollectPictures(request, staged.staging(), &report, progress);
  }
  core::WriteFile(staged.staging() / "proposals.json", ProposalJson(request, report));
  staged.Commit();
  if (!stopped.empty()) {
    throw core::Error(stopped, "", "the pictures so far are kept in " + request.output.string());
  }
  return report;
}

std::string ProposalTable(const ProposalReport& report) {
  std::string table;
  for (const Proposal& proposal : report.proposals) {
    char line[160];
    std::snprintf(line, sizeof(line), "%-28s  %-14s  %s", proposal.category.category.c_str(),
                  proposal.category.source.c_str(), proposal.category.row.c_str());
    table += line;
    for (const ProposedPicture& picture : proposal.pictures) {
      table += picture.test.kept ? "  kept" : "  refused: " + picture.test.reason;
    }
    while (!table.empty() && table.back() == ' ') table.pop_back();
    table += "\n";
  }
  return table;
}

std::string ProposalJson(const ProposalRequest& request, const ProposalReport& report) {
  core::OrderedJson json;
  json["format"] = 1;
  json["theme"] = request.theme;
  json["seed"] = request.seed;
  json["kept"] = report.kept();
  json["refused"] = report.refused();
  json["proposals"] = core::OrderedJson::array();
  for (const Proposal& proposal : report.proposals) {
    core::OrderedJson entry = {{"category", proposal.category.category},
                               {"prompt", proposal.category.prompt},
                               {"source", proposal.category.source}};
    if (!proposal.category.row.empty()) entry["row"] = proposal.category.row;
    if (proposal.category.score > 0.0) {
      entry["score"] = std::round(1000.0 * proposal.category.score) / 1000.0;
    }
    entry["pictures"] = core::OrderedJson::array();
    for (const ProposedPicture& picture : proposal.pictures) {
      entry["pictures"].push_back(PictureJson(picture));
    }
    json["proposals"].push_back(entry);
  }
  json["findings"] = core::FindingsJson(report.findings);
  return core::JsonText(json, core::InvalidUtf8::kReplace);
}

}  // namespace simwright::proposals
