#include "scene/dataset/tokens.h"

#include <algorithm>
#include <cmath>

#include <Eigen/SVD>

#include "core/error.h"

namespace simwright::scene {
namespace {

using RowMajor = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

int ClassOfToken(const float* token, int classes) {
  const float* const first = token + kPoseWidth;
  return static_cast<int>(std::max_element(first, first + classes) - first);
}

std::string FaultOfToken(const float* token, const Vocabulary& vocabulary) {
  const int width = vocabulary.TokenWidth();
  if (!std::all_of(token, token + width, [](float x) { return std::isfinite(x); })) {
    return "a number is not finite";
  }
  const float* const first = token + kPoseWidth;
  const auto ones = std::count(first, token + width, 1.0f);
  const auto zeros = std::count(first, token + width, 0.0f);
  if (ones != 1 || ones + zeros != vocabulary.ClassCount()) return "its class is not one-hot";
  if (ClassOfToken(token, vocabulary.ClassCount()) == vocabulary.EmptyClass()) {
    const bool blank = std::all_of(token, first, [](float x) { return x == 0.0f; });
    return blank ? "" : "a padding token has a pose";
  }
  const Eigen::Matrix3d rotation = Eigen::Map<const RowMajor>(token + 3).cast<double>();
  const double off = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm();
  return off < 1e-3 && rotation.determinant() > 0.0 ? "" : "its matrix is not a rotation";
}

}  // namespace

Eigen::Matrix3d NearestRotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1.0, 1.0, 1.0);
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) signs.z() = -1.0;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

void EncodeScene(const std::vector<SceneObject>& objects, const Vocabulary& vocabulary,
                 float* tokens) {
  if (objects.size() > static_cast<size_t>(vocabulary.entries)) {
    throw core::Error("a scene has " + std::to_string(objects.size()) + " objects, but at most " +
                          std::to_string(vocabulary.entries) + " fit",
                      vocabulary.type);
  }
  const auto width = static_cast<size_t>(vocabulary.TokenWidth());
  std::fill(tokens, tokens + width * static_cast<size_t>(vocabulary.entries), 0.0f);
  for (size_t i = 0; i < static_cast<size_t>(vocabulary.entries); ++i) {
    float* const token = tokens + i * width;
    if (i >= objects.size()) {
      token[kPoseWidth + vocabulary.EmptyClass()] = 1.0f;
      continue;
    }
    const int c = vocabulary.ClassOf(objects[i].category);
    if (c < 0) throw core::Error("the vocabulary has no such category", objects[i].category);
    const Eigen::Isometry3d& pose = objects[i].world_from_object;
    Eigen::Map<Eigen::Vector3f> translation(token);
    Eigen::Map<RowMajor> rotation(token + 3);
    translation = pose.translation().cast<float>();
    rotation = pose.linear().cast<float>();
    token[kPoseWidth + c] = 1.0f;
  }
}

std::vector<SceneObject> DecodeScene(const float* tokens, const Vocabulary& vocabulary) {
  std::vector<SceneObject> objects;
  for (int i = 0; i < vocabulary.entries; ++i) {
    const float* const token = tokens + i * vocabulary.TokenWidth();
    const int c = ClassOfToken(token, vocabulary.ClassCount());
    if (c == vocabulary.EmptyClass()) continue;
    SceneObject object;
    object.category = vocabulary.categories[static_cast<size_t>(c)];
    object.welded = vocabulary.welded[static_cast<size_t>(c)];
    object.world_from_object.translation() =
        Eigen::Map<const Eigen::Vector3f>(token).cast<double>();
    object.world_from_object.linear() =
        NearestRotation(Eigen::Map<const RowMajor>(token + 3).cast<double>());
    objects.push_back(std::move(object));
  }
  return objects;
}

std::vector<std::vector<SceneObject>> DecodeScenes(const std::vector<float>& tokens,
                                                   const Vocabulary& vocabulary) {
  const auto size = static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth());
  if (tokens.size() % size != 0) throw core::Error("tokens are not those of whole scenes");
  std::vector<std::vector<SceneObject>> scenes;
  scenes.reserve(tokens.size() / size);
  for (size_t i = 0; i < tokens.size(); i += size) {
    scenes.push_back(DecodeScene(&tokens[i], vocabulary));
  }
  return scenes;
}

std::string ValidateTokens(const float* tokens, const Vocabulary& vocabulary) {
  for (int i = 0; i < vocabulary.entries; ++i) {
    const std::string fault = FaultOfToken(tokens + i * vocabulary.TokenWidth(), vocabulary);
    if (!fault.empty()) return "entry " + std::to_string(i) + ": " + fault;
  }
  return "";
}

}  // namespace simwright::scene
