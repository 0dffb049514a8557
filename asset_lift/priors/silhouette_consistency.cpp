#include "asset_lift/priors/silhouette_consistency.h"

#include <algorithm>
#include <cmath>

#include "asset_lift/priors/shape_example.h"

namespace simwright::asset_lift {
namespace {

constexpr int kSilhouetteSide = kCropSide;
constexpr size_t kSilhouettePixels = static_cast<size_t>(kSilhouetteSide) * kSilhouetteSide;
constexpr float kEmpty = -8.0f;
constexpr float kSheetPeak = 0.7f;  // log odds in the middle of a sheet
constexpr float kPixel = 2.0f / kSilhouetteSide;
constexpr float kCell = static_cast<float>(2.0 * kDepthReach / kDepthCells);
// The standard deviation of a sheet's depth change between neighbouring pixels.
constexpr float kSlope = 0.7f * kPixel;
constexpr int kIterations = 200;

float DepthOf(int cell) {
  return static_cast<float>(kDepthReach * ((cell + 0.5) * 2.0 / kDepthCells - 1.0));
}

// One pixel's column of the volume.
struct Column {
  bool seen = false;       // inside the silhouette
  bool sure = false;       // the network is certain that the column is occupied
  float center = 0.0f;     // w of the middle
  float precision = 0.0f;  // of the centre, where it is uncertain: one over its variance
  float rim = 0.0f;        // distance to the silhouette's edge
};

Column Read(const ShapePrediction& prediction, size_t pixel) {
  Column column;
  column.seen = prediction.crop.pixels[4 * pixel + 3] > 127;
  double sum = 0.0, mean = 0.0, square = 0.0;
  for (int k = 0; k < kDepthCells; ++k) {
    const float logit = prediction.logits[static_cast<size_t>(k) * kSilhouettePixels + pixel];
    column.sure = column.sure || logit > 0.0f;
    const double share = 1.0 / (1.0 + std::exp(-logit)), w = DepthOf(k);
    sum += share;
    mean += share * w;
    square += share * w * w;
  }
  mean /= sum;
  column.center = static_cast<float>(mean);
  column.precision =
      static_cast<float>(1.0 / (std::max(0.0, square / sum - mean * mean) + kCell * kCell));
  return column;
}

// Computes the distance to the background by passes with the steps 1 and sqrt(2) (Borgefors 1986).
void MeasureRims(std::vector<Column>* columns) {
  const auto at = [&](int x, int y) -> float {
    if (x < 0 || y < 0 || x >= kSilhouetteSide || y >= kSilhouetteSide) return 0.0f;
    return (*columns)[static_cast<size_t>(y) * kSilhouetteSide + static_cast<size_t>(x)].rim;
  };
  for (Column& column : *columns) column.rim = column.seen ? 1e6f : 0.0f;
  const auto relax = [&](int x, int y, int d) {
    float& rim = (*columns)[static_cast<size_t>(y) * kSilhouetteSide + static_cast<size_t>(x)].rim;
    const float straight = std::min(at(x - d, y), at(x, y - d)) + 1.0f;
    const float across = std::min(at(x - d, y - d), at(x + d, y - d)) + static_cast<float>(M_SQRT2);
    rim = std::min({rim, straight, across});
  };
  for (int y = 0; y < kSilhouetteSide; ++y) {
    for (int x = 0; x < kSilhouetteSide; ++x) relax(x, y, 1);
  }
  for (int y = kSilhouetteSide - 1; y >= 0; --y) {
    for (int x = kSilhouetteSide - 1; x >= 0; --x) relax(x, y, -1);
  }
  for (Column& column : *columns) column.rim *= kPixel;
}

// Smooths the centres of uncertain columns towards their neighbours': Gauss-Seidel on the posterior
// of independent measurements and a membrane through them.
void SmoothCenters(std::vector<Column>* columns) {
  const std::vector<Column> read = *columns;
  constexpr float kStiffness = 1.0f / (kSlope * kSlope);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    for (int y = 0; y < kSilhouetteSide; ++y) {
      for (int x = 0; x < kSilhouetteSide; ++x) {
        const size_t pixel = static_cast<size_t>(y) * kSilhouetteSide + static_cast<size_t>(x);
        Column& column = (*columns)[pixel];
        if (!column.seen || column.sure) continue;
        float weight = read[pixel].precision, sum = weight * read[pixel].center;
        const auto draw = [&](int nx, int ny) {
          if (nx < 0 || ny < 0 || nx >= kSilhouetteSide || ny >= kSilhouetteSide) return;
          const Column& next =
              (*columns)[static_cast<size_t>(ny) * kSilhouetteSide + static_cast<size_t>(nx)];
          if (!next.seen) return;
          weight += kStiffness;
          sum += kStiffness * next.center;
        };
        draw(x - 1, y);
        draw(x + 1, y);
        draw(x, y - 1);
        draw(x, y + 1);
        column.center = sum / weight;
      }
    }
  }
}

}  // namespace

void EnforceSilhouetteConsistency(ShapePrediction* prediction) {
  std::vector<Column> columns(kSilhouettePixels);
  for (size_t pixel = 0; pixel < kSilhouettePixels; ++pixel)
    columns[pixel] = Read(*prediction, pixel);
  MeasureRims(&columns);
  SmoothCenters(&columns);
  prediction->front_w.assign(kSilhouettePixels, 0.0f);
  prediction->back_w.assign(kSilhouettePixels, 0.0f);
  for (size_t pixel = 0; pixel < kSilhouettePixels; ++pixel) {
    const Column& column = columns[pixel];
    const bool sheet = column.seen && !column.sure;
    const float half = std::max(column.rim, kCell);
    int first = -1, last = -1;
    for (int k = 0; k < kDepthCells; ++k) {
      float& logit = prediction->logits[static_cast<size_t>(k) * kSilhouettePixels + pixel];
      // Outside the silhouette the volume continues smoothly; Logit() cuts it at the silhouette
      // itself.
      logit = std::max(kEmpty, logit);
      if (sheet) {
        const float off = (DepthOf(k) - column.center) / half;
        logit = std::max(logit, kSheetPeak * (1.0f - off * off));
      }
      if (logit <= 0.0f) continue;
      if (first < 0) first = k;
      last = k;
    }
    if (first < 0) continue;
    prediction->front_w[pixel] = DepthOf(first);
    prediction->back_w[pixel] = DepthOf(last);
  }
}

}  // namespace simwright::asset_lift
