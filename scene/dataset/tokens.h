#pragma once

#include <string>
#include <vector>

#include "scene/dataset/vocabulary.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::scene {

// Writes a scene as (entries x TokenWidth) numbers: translation in metres, rotation matrix in
// row-major order, one-hot class; padding has a pose of zeros and the empty class. The order of
// objects is kept. Throws core::Error for more objects than entries, or a category that the
// vocabulary lacks.
void EncodeScene(const std::vector<SceneObject>& objects, const Vocabulary& vocabulary,
                 float* tokens);

// Returns the scene of the tokens: the most likely class of each token, padding removed, the matrix
// projected to the nearest rotation (special Procrustes). Symbols and parents are unknown. Requires
// finite poses.
std::vector<SceneObject> DecodeScene(const float* tokens, const Vocabulary& vocabulary);
// Returns the scenes of the tokens of several, (count x entries x TokenWidth).
std::vector<std::vector<SceneObject>> DecodeScenes(const std::vector<float>& tokens,
                                                   const Vocabulary& vocabulary);

// Returns an empty text if the tokens are a valid scene: finite, one-hot classes, proper rotations
// (to 1e-3), padding of zeros; otherwise a message with the entry and its error.
std::string ValidateTokens(const float* tokens, const Vocabulary& vocabulary);

// Returns the rotation nearest to a matrix in the least-squares sense: U diag(1, 1, det(U V^T)) V^T
// of its singular value decomposition (special orthogonal Procrustes; Levinson et al. 2020).
Eigen::Matrix3d NearestRotation(const Eigen::Matrix3d& matrix);

}  // namespace simwright::scene
