#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "llm/chat_model.h"
#include "proposals/category_proposals.h"
#include "proposals/uncluttered_test.h"
#include "texture/image_generator.h"

namespace simwright::proposals {

struct ProposalRequest {
  std::string theme;                             // "kitchen"
  int count = 50;                                // categories
  int pictures = 1;                              // of each category
  int size = 768;                                // pixels a side of fetched pictures
  llm::ChatModel* model = nullptr;               // null: categories offline
  texture::ImageGenerator* generator = nullptr;  // fetches pictures; null: `images`
  std::filesystem::path images;                  // a folder of pictures by category; empty: none
  UnclutteredLimits limits;
  std::uint64_t seed = 1;
  std::filesystem::path output;  // a folder
  bool force = false;

  // Returns false, with the reason, unless there is a theme, one source of pictures at most, and
  // the numbers can be used.
  bool IsValid(std::string* error) const;
};

// A picture of a proposal.
struct ProposedPicture {
  std::string file;        // in the output folder: "pictures/mug_1.png"; empty if there is none
  std::string source;      // the generator's name, or the file it was taken from
  std::uint64_t seed = 0;  // of the generator
  UnclutteredResult test;  // its reason also says why there is no picture
};

struct Proposal {
  CategoryProposal category;
  std::vector<ProposedPicture> pictures;
};

struct ProposalReport {
  std::vector<Proposal> proposals;
  core::Findings findings;
  std::filesystem::path output;
  bool interrupted = false;  // Ctrl-C ended the fetching; the folder has what was there

  int kept() const;     // pictures
  int refused() const;  // pictures that failed the test
};

// Proposes categories for a theme, with prompts and, if a source is given, pictures, and writes
// them to a folder: proposals.json (docs/propose.md), pictures/ and, with pictures, sheet.png, on
// which refused ones have a red frame. Pictures that fail the test stay, marked as refused. Three
// failures of the generator in a row end the fetching, with the finding "pictures-ended"; the first
// one is thrown. If Ctrl-C or an error ends the work after the first picture, the folder is written
// with what is there and the finding "proposals-stopped": after Ctrl-C the report is returned as
// `interrupted`, and an error is thrown. Throws core::Error also for an invalid request and
// as OfflineCategories, LanguageModelCategories and ReadPictureFolder do; throws core::Cancelled
// before the first picture.
ProposalReport Propose(const ProposalRequest& request, core::Progress* progress);

// Formats a table for a terminal, and the report as JSON, which is also proposals.json.
std::string ProposalTable(const ProposalReport& report);
std::string ProposalJson(const ProposalRequest& request, const ProposalReport& report);

}  // namespace simwright::proposals
