#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/image.h"

namespace simwright::capture {

enum class PaperSize { kA4, kA3, kLetter };

// A printed mat on which an object is photographed: a ChArUco board, that is a chessboard with an
// ArUco marker (dictionary 5x5_250) in each light square, and a ruler. It is printed in two colours
// that household objects rarely have, so that white, grey and black objects stand out; a print in
// grey works too, except for those. Its frame has the origin at
// the page's centre, x to the right and y to the top of the page, z out of the paper. Each paper
// size has markers of its own, so that a photo tells which mat it shows.
struct CaptureMat {
  PaperSize paper = PaperSize::kA4;
  std::string name;                   // "A4", "A3", "letter"
  double width = 0.0, height = 0.0;   // of the page, m
  int columns = 0, rows = 0;          // squares
  double square = 0.0, marker = 0.0;  // their sides, m
  int first_marker = 0;               // the first marker's id
  double ruler_y = 0.0, ruler = 0.0;  // the ruler's position and length, m

  // Returns the coloured area (mat frame, m): the page but for the ruler and a white margin.
  Eigen::AlignedBox2d Printed() const;
  int corner_count() const { return (columns - 1) * (rows - 1); }
  // Returns the position of an inner corner of the chessboard, row by row from the upper left.
  // Requires 0 <= corner < corner_count().
  Eigen::Vector3d Corner(int corner) const;
};

// The printed colours, sRGB in [0, 1].
inline const Eigen::Vector3d kMatDark{0.50, 0.0, 0.36};    // purple
inline const Eigen::Vector3d kMatLight{0.72, 0.93, 0.76};  // pale green

// Returns the mats of all paper sizes.
const std::array<CaptureMat, 3>& CaptureMats();
// Returns the mat of a paper size.
const CaptureMat& CaptureMatOf(PaperSize paper);

// Returns the dark areas of the mat's squares and markers as rectangles (mat frame, m).
std::vector<Eigen::AlignedBox2d> DarkRectangles(const CaptureMat& mat);

// Draws the page's squares and markers without ruler and text: 1 channel, dark areas 0, light ones
// and the rest of the page 255, antialiased.
// `pixels_per_metre` > 0.
core::Image MatPicture(const CaptureMat& mat, double pixels_per_metre);

// Returns a PDF (version 1.4) of one page at true size: the board, a ruler of 10 cm to check the
// print with, and how to use it.
std::string MatPdf(const CaptureMat& mat);

}  // namespace simwright::capture
