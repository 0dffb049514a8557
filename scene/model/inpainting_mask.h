#pragma once

#include <string>
#include <vector>

#include "scene/dataset/vocabulary.h"

namespace simwright::scene {

// The way in which the kept values enter the noisy scenes of the sampling.
enum class Clamping {
  // Their clean values, at every step: the published code of Pfaff et al.
  kCleanValues,
  // A new sample of q(x_t | x_0) at every step (Lugmayr et al. 2022, RePaint, equation 8a), so that
  // the network receives noise as in training.
  kForwardNoised,
};

// The values of scenes that a model synthesizes; it keeps the others. One flag per entry, (count x
// entries) each: 1 to synthesize, 0 to keep. Completion synthesizes pose and class of padding,
// rearrangement the poses only.
struct InpaintingMask {
  std::vector<char> pose, classes;
  // 1 for a class that a synthesized entry must not become, (count x entries x ClassCount); empty:
  // all are allowed. With the empty class in it, the entry becomes an object.
  std::vector<char> forbidden = {};

  // Returns the mask that synthesizes everything.
  static InpaintingMask All(int count, int entries);

  // Forbids one class of an entry, an index 0 .. count x entries - 1.
  void Forbid(const Vocabulary& vocabulary, int entry, int one_class);

  // Returns true if the mask fits the tokens (count x entries x TokenWidth): the sizes agree, all
  // values are finite, kept classes are one-hot, each synthesized class has one that is allowed,
  // and where only the class is synthesized, there is an object.
  bool IsValid(const std::vector<float>& tokens, const Vocabulary& vocabulary,
               std::string* error) const;
};

}  // namespace simwright::scene
