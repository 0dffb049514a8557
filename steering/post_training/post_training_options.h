#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "nn/trainer_options.h"

namespace simwright::steering {

// Policy gradient on the denoising steps (Black et al. 2024, DDPO, with importance sampling), with
// the loss on data as a regulariser. Published for scenes (Pfaff et al.): 256 scenes a round in 150
// steps of which 100 carry a gradient, rate 1e-6, a data weight of 200 to 500 on another scale, 20
// more entries. The defaults are for the small models and the time of two cores.
struct PostTrainingOptions {
  int rounds = 120;          // of sampling, each with `updates` updates
  int scenes = 64;           // per round
  int steps = 40;            // denoising steps of a scene
  int gradient_steps = 8;    // denoising steps with a gradient in an update, other ones in each
  int updates = 2;           // updates per round
  double clip = 0.2;         // of the importance ratio of a step, per entry, around 1
  int data_batch = 32;       // scenes of the data in an update
  double data_weight = 1.0;  // of the loss on data, relative to the policy's
  // Entries beyond those of the model, so that scenes may have more objects than the data.
  int more_entries = 20;
  int score_every = 10;        // rounds between checkpoints
  int scored_scenes = 256;     // sampled to score a checkpoint
  nn::TrainerOptions trainer;  // its steps are set from `rounds` and `updates`
  std::uint64_t seed = 1;

  PostTrainingOptions();
  bool IsValid(std::string* error) const;
};

}  // namespace simwright::steering
