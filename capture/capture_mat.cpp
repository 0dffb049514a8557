#include "capture/capture_mat.h"

#include <algorithm>
#include <cmath>

#include <opencv2/aruco.hpp>

#include "core/error.h"

namespace simwright::capture {
namespace {

constexpr double kPrinterMargin = 0.006;  // m, of the page's edge, which printers leave white
constexpr double kRulerHeight = 0.006;    // m

CaptureMat MakeMat(PaperSize paper, const char* name, double width, double height, int columns,
                   int rows, double square, int first_marker) {
  CaptureMat mat;
  mat.paper = paper;
  mat.name = name;
  mat.width = width;
  mat.height = height;
  mat.columns = columns;
  mat.rows = rows;
  mat.square = square;
  mat.marker = 0.75 * square;
  mat.first_marker = first_marker;
  mat.ruler = 0.1;
  mat.ruler_y = -0.5 * height + 0.011;
  return mat;
}

// The board's upper left corner in the mat's frame.
Eigen::Vector2d BoardOrigin(const CaptureMat& mat) {
  return {-0.5 * mat.columns * mat.square, 0.5 * mat.rows * mat.square};
}

// A marker has 5 x 5 cells within a black border of one cell.
constexpr int kMarkerCells = 7;

void AddMarker(const CaptureMat& mat, int marker, const Eigen::Vector2d& low,
               std::vector<Eigen::AlignedBox2d>* dark) {
  cv::Mat cells;
  cv::aruco::drawMarker(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_250),
                        mat.first_marker + marker, kMarkerCells, cells);
  const double cell = mat.marker / kMarkerCells;
  for (int row = 0; row < kMarkerCells; ++row) {
    for (int from = 0; from < kMarkerCells; ++from) {
      if (cells.at<std::uint8_t>(row, from) != 0) continue;
      int to = from;
      while (to < kMarkerCells && cells.at<std::uint8_t>(row, to) == 0) ++to;
      const double top = low.y() + mat.marker - row * cell;
      dark->emplace_back(Eigen::Vector2d(low.x() + from * cell, top - cell),
                         Eigen::Vector2d(low.x() + to * cell, top));
      from = to;
    }
  }
}

}  // namespace

Eigen::Vector3d CaptureMat::Corner(int corner) const {
  if (corner < 0 || corner >= corner_count()) {
    throw core::Error("has no corner " + std::to_string(corner), "the " + name + " mat");
  }
  const Eigen::Vector2d at =
      BoardOrigin(*this) +
      square * Eigen::Vector2d(1 + corner % (columns - 1), -1 - corner / (columns - 1));
  return {at.x(), at.y(), 0.0};
}

Eigen::AlignedBox2d CaptureMat::Printed() const {
  const Eigen::Vector2d half =
      0.5 * Eigen::Vector2d(width, height) - Eigen::Vector2d::Constant(kPrinterMargin);
  return {Eigen::Vector2d(-half.x(), ruler_y + kRulerHeight), half};
}

const std::array<CaptureMat, 3>& CaptureMats() {
  // The squares leave 15 mm for the printer's margins and, below, the ruler.
  static const std::array<CaptureMat, 3> mats = {
      MakeMat(PaperSize::kA4, "A4", 0.210, 0.297, 8, 11, 0.022, 0),
      MakeMat(PaperSize::kA3, "A3", 0.297, 0.420, 8, 12, 0.032, 60),
      MakeMat(PaperSize::kLetter, "letter", 0.2159, 0.2794, 8, 10, 0.023, 120)};
  return mats;
}

const CaptureMat& CaptureMatOf(PaperSize paper) {
  for (const CaptureMat& mat : CaptureMats()) {
    if (mat.paper == paper) return mat;
  }
  throw core::Error("there is no mat of this paper size");
}

std::vector<Eigen::AlignedBox2d> DarkRectangles(const CaptureMat& mat) {
  std::vector<Eigen::AlignedBox2d> dark;
  const Eigen::Vector2d origin = BoardOrigin(mat);
  const double margin = 0.5 * (mat.square - mat.marker);
  int marker = 0;
  // The order of OpenCV's board: row by row from the top.
  for (int row = 0; row < mat.rows; ++row) {
    for (int column = 0; column < mat.columns; ++column) {
      const Eigen::Vector2d low = origin + mat.square * Eigen::Vector2d(column, -1 - row);
      if (row % 2 == column % 2) {
        dark.emplace_back(low, low + Eigen::Vector2d::Constant(mat.square));
      } else {
        AddMarker(mat, marker++, low + Eigen::Vector2d::Constant(margin), &dark);
      }
    }
  }
  return dark;
}

core::Image MatPicture(const CaptureMat& mat, double pixels_per_metre) {
  core::Image picture(static_cast<int>(std::lround(mat.width * pixels_per_metre)),
                      static_cast<int>(std::lround(mat.height * pixels_per_metre)), 1, 255);
  const double sx = picture.width / mat.width, sy = picture.height / mat.height;
  for (const Eigen::AlignedBox2d& box : DarkRectangles(mat)) {
    const double left = sx * (box.min().x() + 0.5 * mat.width);
    const double right = sx * (box.max().x() + 0.5 * mat.width);
    const double top = sy * (0.5 * mat.height - box.max().y());
    const double bottom = sy * (0.5 * mat.height - box.min().y());
    for (int y = static_cast<int>(top); y < bottom && y < picture.height; ++y) {
      const double rows = std::min(bottom, y + 1.0) - std::max(top, static_cast<double>(y));
      for (int x = static_cast<int>(left); x < right && x < picture.width; ++x) {
        const double columns = std::min(right, x + 1.0) - std::max(left, static_cast<double>(x));
        std::uint8_t* pixel = picture.At(x, y);
        // Rectangles share no area, so their shares of a pixel add up.
        *pixel = static_cast<std::uint8_t>(
            std::max<long>(0, std::lround(*pixel - 255.0 * rows * columns)));
      }
    }
  }
  return picture;
}

}  // namespace simwright::capture
