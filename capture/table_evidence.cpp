#include "capture/table_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/parallel.h"

namespace simwright::capture {
namespace {

constexpr float kAgreeing = 28.0f;      // of 255: the distance of colours that agree
constexpr float kLeastSupport = 0.5f;   // share of the photos that see a cell of the table
constexpr int kLeastSamples = 3;        // photos that show a cell
constexpr int kWindow = 11;             // pixels of a window in which patterns are compared
constexpr float kEvenVariance = 36.0f;  // of 255^2: an even table has no pattern
constexpr float kPixelNoise = 7.0f;     // standard deviation of a pixel's value, of 255
constexpr float kSlopeShare = 0.35f;  // of the change between neighbours, as cameras are not exact
constexpr float kLeastLight = 0.85f, kMostLight = 1.15f;  // gloss and soft shadows of moving things
constexpr int kSamplesPerSide = 3;                        // of the table in a pixel

struct ColorSample {
  Eigen::Vector3f color;
  float weight = 0.0f;
};

class TablePainter {
 public:
  TablePainter(const std::vector<TableView>& views, const Eigen::AlignedBox2d& area, int cells)
      : views_(views) {
    if (area.isEmpty() || cells < 8) throw core::Error("the area is empty", "table");
    table_.area = area;
    table_.color = core::FloatImage(cells, cells, 3);
    table_.support = core::FloatImage(cells, cells, 1);
    table_.gains.assign(views.size(), Eigen::Vector3d::Ones());
    for (const TableView& view : views) {
      camera_from_world_.push_back(view.camera->world_from_camera.inverse());
    }
  }

  TablePicture Run() {
    Paint();
    FitGains();
    Paint();
    return std::move(table_);
  }

 private:
  Eigen::Vector3d PointOf(int x, int y) const {
    const Eigen::Vector2d sides = table_.area.sizes();
    return {table_.area.min().x() + (x + 0.5) / table_.color.width * sides.x(),
            table_.area.max().y() - (y + 0.5) / table_.color.height * sides.y(), 0.0};
  }

  // Reads the colour that a view shows at a point of the table, if it shows it.
  bool Sample(std::size_t view, const Eigen::Vector3d& point, ColorSample* sample) const {
    const core::Camera& camera = *views_[view].camera;
    const Eigen::Vector3d at = camera_from_world_[view] * point;
    if (!(at.z() > 0.0)) return false;
    const double u = camera.fx * at.x() / at.z() + camera.cx - 0.5;
    const double v = camera.fy * at.y() / at.z() + camera.cy - 0.5;
    const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
    if (x < 0 || y < 0 || x + 1 >= camera.width || y + 1 >= camera.height) return false;
    if (views_[view].hull != nullptr && *views_[view].hull->At(x, y) > 0.01f) return false;
    const auto a = static_cast<float>(u - x), b = static_cast<float>(v - y);
    const core::Image& photo = *views_[view].photo;
    for (int c = 0; c < 3; ++c) {
      const float value = (1 - b) * ((1 - a) * photo.At(x, y)[c] + a * photo.At(x + 1, y)[c]) +
                          b * ((1 - a) * photo.At(x, y + 1)[c] + a * photo.At(x + 1, y + 1)[c]);
      sample->color[c] = value / static_cast<float>(table_.gains[view][c]);
    }
    // Views from above show the table sharper.
    const Eigen::Vector3d eye = camera.position() - point;
    const auto sine = static_cast<float>(eye.z() / eye.norm());
    sample->weight = sine * sine;
    return sine > 0.05f;
  }

  void Paint() {
    core::ParallelFor(table_.color.height, [&](int y) {
      std::vector<ColorSample> samples;
      for (int x = 0; x < table_.color.width; ++x) PaintCell(x, y, &samples);
    });
  }

  void PaintCell(int x, int y, std::vector<ColorSample>* samples) {
    samples->clear();
    const Eigen::Vector3d point = PointOf(x, y);
    ColorSample sample;
    for (std::size_t view = 0; view < views_.size(); ++view) {
      if (Sample(view, point, &sample)) samples->push_back(sample);
    }
    *table_.support.At(x, y) = 0.0f;
    if (static_cast<int>(samples->size()) < kLeastSamples) return;
    int best = -1, best_count = 0;
    for (std::size_t i = 0; i < samples->size(); ++i) {
      const auto count = static_cast<int>(
          std::count_if(samples->begin(), samples->end(), [&](const ColorSample& other) {
            return (other.color - (*samples)[i].color).squaredNorm() < kAgreeing * kAgreeing;
          }));
      if (count <= best_count) continue;
      best_count = count;
      best = static_cast<int>(i);
    }
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float weight = 0.0f;
    const Eigen::Vector3f center = (*samples)[static_cast<std::size_t>(best)].color;
    for (const ColorSample& other : *samples) {
      if ((other.color - center).squaredNorm() >= kAgreeing * kAgreeing) continue;
      sum += other.weight * other.color;
      weight += other.weight;
    }
    for (int c = 0; c < 3; ++c) table_.color.At(x, y)[c] = sum[c] / weight;
    const float share = static_cast<float>(best_count) / static_cast<float>(samples->size());
    if (share >= kLeastSupport && best_count >= kLeastSamples) *table_.support.At(x, y) = share;
  }

  // Measures each view's exposure as the median of its colours over the picture's.
  void FitGains() {
    core::ParallelFor(static_cast<int>(views_.size()), [&](int view) {
      std::array<std::vector<double>, 3> ratios;
      ColorSample sample;
      for (int y = 0; y < table_.color.height; y += 3) {
        for (int x = 0; x < table_.color.width; x += 3) {
          if (*table_.support.At(x, y) == 0.0f) continue;
          if (!Sample(static_cast<std::size_t>(view), PointOf(x, y), &sample)) continue;
          for (int c = 0; c < 3; ++c) {
            const float painted = table_.color.At(x, y)[c];
            if (painted > 8.0f)
              ratios[static_cast<std::size_t>(c)].push_back(sample.color[c] / painted);
          }
        }
      }
      for (int c = 0; c < 3; ++c) {
        std::vector<double>& all = ratios[static_cast<std::size_t>(c)];
        if (all.size() < 50) continue;
        std::nth_element(all.begin(), all.begin() + all.size() / 2, all.end());
        table_.gains[static_cast<std::size_t>(view)][c] = std::clamp(all[all.size() / 2], 0.5, 2.0);
      }
    });
  }

  const std::vector<TableView>& views_;
  std::vector<Eigen::Isometry3d> camera_from_world_;
  TablePicture table_;
};

// Renders the table that a view should show: its colours (CV_32FC3), and where it is known
// (CV_32F).
void ShowTable(const core::Camera& camera, const TablePicture& table, cv::Mat* color,
               cv::Mat* known) {
  *color = cv::Mat(camera.height, camera.width, CV_32FC3, cv::Scalar::all(0));
  *known = cv::Mat(camera.height, camera.width, CV_32F, cv::Scalar(0));
  const Eigen::Vector3d eye = camera.position();
  const Eigen::Vector2d sides = table.area.sizes();
  core::ParallelFor(camera.height, [&](int y) {
    for (int x = 0; x < camera.width; ++x) {
      cv::Vec3f sum(0, 0, 0);
      int count = 0;
      for (int k = 0; k < kSamplesPerSide * kSamplesPerSide; ++k) {
        const Eigen::Vector3d ray = camera.Ray({x + (k % kSamplesPerSide + 0.5) / kSamplesPerSide,
                                                y + (k / kSamplesPerSide + 0.5) / kSamplesPerSide});
        if (!(ray.z() < 0.0)) continue;
        const Eigen::Vector3d point = eye - eye.z() / ray.z() * ray;
        const double u = (point.x() - table.area.min().x()) / sides.x() * table.color.width;
        const double v = (table.area.max().y() - point.y()) / sides.y() * table.color.height;
        if (!(u >= 0.0 && v >= 0.0 && u < table.color.width && v < table.color.height)) continue;
        const int i = static_cast<int>(u), j = static_cast<int>(v);
        if (*table.support.At(i, j) == 0.0f) continue;
        const float* cell = table.color.At(i, j);
        sum += cv::Vec3f(cell[0], cell[1], cell[2]);
        ++count;
      }
      if (2 * count < kSamplesPerSide * kSamplesPerSide) continue;
      color->at<cv::Vec3f>(y, x) = sum / static_cast<float>(count);
      known->at<float>(y, x) = 1.0f;
    }
  });
}

cv::Mat WindowSum(const cv::Mat& values) {
  cv::Mat sum;
  cv::boxFilter(values, sum, CV_32F, {kWindow, kWindow}, {-1, -1}, false, cv::BORDER_CONSTANT);
  return sum;
}

// Returns the correlation of two grey images in a window about each known pixel; 0 where the table
// is even.
cv::Mat WindowCorrelation(const cv::Mat& grey, const cv::Mat& table, const cv::Mat& known) {
  const cv::Mat a = table.mul(known), g = grey.mul(known);
  const cv::Mat n = WindowSum(known), sa = WindowSum(a), sg = WindowSum(g),
                saa = WindowSum(a.mul(a)), sgg = WindowSum(g.mul(g)), sag = WindowSum(a.mul(g));
  cv::Mat correlation(grey.size(), CV_32F, cv::Scalar(0));
  for (int y = 0; y < grey.rows; ++y) {
    for (int x = 0; x < grey.cols; ++x) {
      const float count = n.at<float>(y, x);
      if (known.at<float>(y, x) == 0.0f || count < 9.0f) continue;
      const float ma = sa.at<float>(y, x) / count, mg = sg.at<float>(y, x) / count;
      const float va = saa.at<float>(y, x) / count - ma * ma;
      const float vg = sgg.at<float>(y, x) / count - mg * mg;
      if (va < kEvenVariance) continue;
      const float covariance = sag.at<float>(y, x) / count - ma * mg;
      correlation.at<float>(y, x) = std::clamp(
          covariance / std::sqrt(va * std::max(vg, kPixelNoise * kPixelNoise)), -1.0f, 1.0f);
    }
  }
  return correlation;
}

// Returns the distance of a colour from the table's, in deviations, under the best light.
float ColorDifference(const cv::Vec3f& color, const cv::Vec3f& expected, const cv::Vec3f& slope) {
  float best = 1e9f;
  for (float light = kLeastLight; light <= kMostLight; light += 0.05f) {
    float squared = 0.0f;
    for (int c = 0; c < 3; ++c) {
      const float d = (color[c] - light * expected[c]) / (kPixelNoise + kSlopeShare * slope[c]);
      squared += d * d;
    }
    best = std::min(best, squared);
  }
  return std::sqrt(best / 3.0f);
}

}  // namespace

TablePicture PaintTable(const std::vector<TableView>& views, const Eigen::AlignedBox2d& area,
                        int cells) {
  return TablePainter(views, area, cells).Run();
}

MatEvidence CompareWithTable(const TableView& view, const TablePicture& table, int index) {
  const core::Image& photo = *view.photo;
  if (photo.width != view.camera->width || photo.height != view.camera->height ||
      photo.channels < 3) {
    throw core::Error("the photo does not have the size of its camera", "table comparison");
  }
  cv::Mat expected, known, color, grey, table_grey, highest, lowest;
  ShowTable(*view.camera, table, &expected, &known);
  cv::Mat rgb(photo.height, photo.width, CV_8UC(photo.channels),
              const_cast<std::uint8_t*>(photo.pixels.data()));
  if (photo.channels == 4) cv::cvtColor(rgb, rgb, cv::COLOR_RGBA2RGB);
  rgb.convertTo(color, CV_32FC3);
  const Eigen::Vector3d& gain = table.gains.at(static_cast<std::size_t>(index));
  cv::divide(color, cv::Scalar(gain.x(), gain.y(), gain.z()), color);
  cv::cvtColor(color, grey, cv::COLOR_RGB2GRAY);
  cv::cvtColor(expected, table_grey, cv::COLOR_RGB2GRAY);
  const cv::Mat pattern = WindowCorrelation(grey, table_grey, known);
  cv::dilate(expected, highest, {});
  cv::erode(expected, lowest, {});
  MatEvidence evidence;
  evidence.difference = core::FloatImage(photo.width, photo.height, 1, -1.0f);
  evidence.pattern = core::FloatImage(photo.width, photo.height, 1);
  evidence.expected = core::Image(photo.width, photo.height, 3);
  core::ParallelFor(photo.height, [&](int y) {
    for (int x = 0; x < photo.width; ++x) {
      *evidence.pattern.At(x, y) = pattern.at<float>(y, x);
      if (known.at<float>(y, x) == 0.0f) continue;
      for (int c = 0; c < 3; ++c) {
        evidence.expected.At(x, y)[c] =
            cv::saturate_cast<std::uint8_t>(gain[c] * expected.at<cv::Vec3f>(y, x)[c]);
      }
      *evidence.difference.At(x, y) =
          ColorDifference(color.at<cv::Vec3f>(y, x), expected.at<cv::Vec3f>(y, x),
                          highest.at<cv::Vec3f>(y, x) - lowest.at<cv::Vec3f>(y, x));
    }
  });
  return evidence;
}

}  // namespace simwright::capture
