#pragma once

#include <string>
#include <vector>

#include "scene/dataset/vocabulary.h"
#include "scene/grammar/scene_draw.h"

namespace simwright::scene {

// Writes a scene as (entries x TokenWidth) numbers: translation in metres, rotation matrix row by
// row, one-hot class; what pads it has a pose of zeros and the empty class. Order is kept. Throws
// core::Error for more objects than entries, or a slot that the vocabulary does not know.
void EncodeScene(const std::vector<DrawnObject>& objects, const Vocabulary& vocabulary,
                 float* tokens);

// The scene that tokens stand for: the most likely class of each, padding left out, the rotation
// nearest to the matrix (special Procrustes). Symbols and parents are not known. Poses have to be
// finite.
std::vector<DrawnObject> DecodeScene(const float* tokens, const Vocabulary& vocabulary);

// Empty where the tokens are a scene: finite, one class each, proper rotations (to 1e-3), padding
// of zeros; else what is wrong, and of which entry.
std::string FaultOfTokens(const float* tokens, const Vocabulary& vocabulary);

// The rotation nearest to a matrix by the sum of squares: U diag(1, 1, det(U V^T)) V^T of its
// singular value decomposition (special orthogonal Procrustes; Levinson et al. 2020).
Eigen::Matrix3d NearestRotation(const Eigen::Matrix3d& matrix);

}  // namespace simwright::scene
