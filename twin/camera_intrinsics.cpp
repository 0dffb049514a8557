#include "twin/camera_intrinsics.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "core/json.h"

namespace simwright::twin {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMostCalibrationBytes = 1u << 20;
constexpr std::size_t kMostNumbers = 64;                // of a member that counts
constexpr double kAspectTolerance = 0.01;               // relative
constexpr double kSquareTolerance = 0.02;               // of fy over fx
constexpr double kFarPrincipal = 0.1;                   // of a side, from the centre: reported
constexpr double kImplausiblePrincipal = 0.25;          // refused
constexpr double kVisibleDistortion = 0.02;             // of a coefficient: reported
constexpr double kLeastFocal = 0.3, kMostFocal = 10.0;  // widths of the photo
constexpr char kCalibrationForm[] =
    "give JSON or YAML with fx, fy, cx, cy, width and height, or a camera_info file of ROS";

// The numbers of a calibration by the name of their member: "fx", "camera_matrix.data".
using NumbersByName = std::map<std::string, std::vector<double>>;

void AddJson(const core::Json& json, const std::string& name, int depth, NumbersByName* numbers) {
  std::vector<double>& of = (*numbers)[name];
  if (json.is_number()) {
    if (of.size() < kMostNumbers) of.push_back(json.get<double>());
  } else if (json.is_array() && depth < 4) {
    for (const core::Json& element : json) AddJson(element, name, depth + 1, numbers);
  } else if (json.is_object() && depth < 4) {
    for (const auto& [key, value] : json.items()) {
      AddJson(value, name.empty() ? key : name + "." + key, depth + 1, numbers);
    }
  }
}

// Appends the numbers of a line: "[1, 2.5]", "- 3", "4".
void AddNumbers(const std::string& text, std::vector<double>* numbers) {
  std::string blank = text;
  for (char& c : blank) {
    if (c == '[' || c == ']' || c == ',') c = ' ';
  }
  std::istringstream words(blank);
  for (std::string word; words >> word;) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (end != word.c_str() && *end == '\0' && numbers->size() < kMostNumbers) {
      numbers->push_back(value);
    }
  }
}

// Reads the subset of YAML of calibrations: members in blocks, numbers and lists of numbers. Its
// other values are passed over.
NumbersByName YamlNumbers(const std::string& text) {
  NumbersByName numbers;
  std::istringstream lines(text);
  std::string block, member;
  for (std::string line; std::getline(lines, line);) {
    line = line.substr(0, line.find('#'));
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos) continue;
    const std::size_t colon = line.find(':');
    const bool named =
        colon != std::string::npos && std::isalpha(static_cast<unsigned char>(line[first])) != 0;
    if (!named) {
      // A dash before a blank begins an entry of a list; before a digit it is a sign.
      const bool entry = line[first] == '-' && first + 1 < line.size() && line[first + 1] == ' ';
      if (!member.empty()) AddNumbers(line.substr(entry ? first + 1 : first), &numbers[member]);
      continue;
    }
    const std::string key = line.substr(first, colon - first);
    if (first == 0) block = key;
    member = first == 0 ? key : block + "." + key;
    AddNumbers(line.substr(colon + 1), &numbers[member]);
  }
  return numbers;
}

NumbersByName ReadNumbers(const fs::path& file) {
  const std::string text = core::ReadFile(file, kMostCalibrationBytes);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  NumbersByName numbers;
  if (first != std::string::npos && text[first] == '{') {
    AddJson(core::ParseJson(text, file.string()), "", 0, &numbers);
  } else {
    numbers = YamlNumbers(text);
  }
  return numbers;
}

// The members of one calibration.
class Calibration {
 public:
  explicit Calibration(const fs::path& file) : file_(file), numbers_(ReadNumbers(file)) {}

  // Returns the numbers of the first member that has `count`, or none.
  std::vector<double> Find(std::initializer_list<const char*> names, std::size_t count) const {
    for (const char* name : names) {
      const auto found = numbers_.find(name);
      if (found != numbers_.end() && found->second.size() == count) return found->second;
    }
    return {};
  }

  std::vector<double> Distortion() const {
    for (const char* name : {"distortion_coefficients.data", "D", "d", "distortion"}) {
      const auto found = numbers_.find(name);
      if (found != numbers_.end() && !found->second.empty()) return found->second;
    }
    return {};
  }

  [[noreturn]] void Fail(const std::string& what,
                         const std::string& remedy = kCalibrationForm) const {
    throw core::Error(what, file_.string(), remedy);
  }

 private:
  fs::path file_;
  NumbersByName numbers_;
};

struct Pinhole {
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  // pixels
};

Pinhole PinholeOf(const Calibration& calibration) {
  const std::vector<double> matrix =
      calibration.Find({"camera_matrix.data", "camera_matrix", "K", "k", "intrinsics"}, 9);
  Pinhole lens;
  if (!matrix.empty()) {
    lens = {matrix[0], matrix[4], matrix[2], matrix[5]};
    if (std::abs(matrix[8] - 1.0) > 1e-6 || matrix[3] != 0.0 || matrix[6] != 0.0) {
      calibration.Fail("the camera's matrix is not of the rows fx 0 cx, 0 fy cy, 0 0 1");
    }
  } else {
    double* const values[] = {&lens.fx, &lens.fy, &lens.cx, &lens.cy};
    const char* const names[] = {"fx", "fy", "cx", "cy"};
    for (int i = 0; i < 4; ++i) {
      const std::vector<double> found = calibration.Find({names[i]}, 1);
      if (found.empty()) {
        calibration.Fail(std::string("the calibration has neither ") + names[i] +
                         " nor a camera matrix of nine numbers");
      }
      *values[i] = found[0];
    }
  }
  const bool finite = std::isfinite(lens.fx) && std::isfinite(lens.fy) && std::isfinite(lens.cx) &&
                      std::isfinite(lens.cy);
  if (!finite || !(lens.fx > 0.0) || !(lens.fy > 0.0)) {
    calibration.Fail("the focal lengths must be positive numbers of pixels");
  }
  return lens;
}

// Returns the size of the pictures that were calibrated: the photo's where the file states none.
Eigen::Vector2d CalibratedSize(const Calibration& calibration, int width, int height) {
  const std::vector<double> w = calibration.Find({"width", "image_width"}, 1);
  const std::vector<double> h = calibration.Find({"height", "image_height"}, 1);
  if (w.empty() && h.empty()) return {width, height};
  if (w.empty() || h.empty()) {
    calibration.Fail("states only one of the width and height of the calibrated pictures");
  }
  if (!(w[0] >= 1.0 && w[0] <= 1e5 && h[0] >= 1.0 && h[0] <= 1e5)) {
    calibration.Fail("the size of the calibrated pictures is not 1 to 100000 pixels");
  }
  const double aspect = w[0] / h[0] * height / width;
  if (std::abs(aspect - 1.0) > kAspectTolerance) {
    calibration.Fail("the calibration is of pictures of another aspect: " +
                         std::to_string(static_cast<int>(w[0])) + " x " +
                         std::to_string(static_cast<int>(h[0])) + ", and the photo has " +
                         std::to_string(width) + " x " + std::to_string(height),
                     "do not crop the photo, or calibrate it as it is");
  }
  return {w[0], h[0]};
}

void ReportDistortion(const Calibration& calibration, const std::string& place,
                      core::Findings* findings) {
  double largest = 0.0;
  for (const double value : calibration.Distortion()) largest = std::max(largest, std::abs(value));
  if (!(largest > kVisibleDistortion)) return;
  findings->push_back({"twin-distortion", core::Severity::kWarning, place,
                       "the lens distorts, which is not undone", largest,
                       "give a rectified photo with the calibration of the rectified pictures"});
}

}  // namespace

CameraIntrinsics ReadCameraIntrinsics(const fs::path& file, int width, int height) {
  const Calibration calibration(file);
  const Pinhole lens = PinholeOf(calibration);
  const Eigen::Vector2d size = CalibratedSize(calibration, width, height);
  if (std::abs(lens.fy / lens.fx - 1.0) > kSquareTolerance) {
    calibration.Fail("the pixels are not square: fx and fy differ by more than 2 %",
                     "scale the photo along one side so that they agree");
  }
  CameraIntrinsics intrinsics;
  intrinsics.focal = 0.5 * (lens.fx + lens.fy) / size.x();
  if (!(intrinsics.focal >= kLeastFocal && intrinsics.focal <= kMostFocal)) {
    calibration.Fail("the focal length is outside of 0.3 to 10 widths of the picture",
                     "state the width and height of the calibrated pictures");
  }
  intrinsics.principal = {lens.cx / size.x(), lens.cy / size.y()};
  const double off = (intrinsics.principal.array() - 0.5).abs().maxCoeff();
  if (!(off <= kImplausiblePrincipal)) {
    calibration.Fail("the principal point is farther than a quarter of a side from the centre",
                     "state the width and height of the calibrated pictures");
  }
  if (off > kFarPrincipal) {
    intrinsics.findings.push_back({"twin-principal-point", core::Severity::kWarning,
                                   file.filename().string(),
                                   "the principal point is far from the centre of the photo, as in "
                                   "a cropped one",
                                   off, "check that the calibration is of this camera"});
  }
  ReportDistortion(calibration, file.filename().string(), &intrinsics.findings);
  return intrinsics;
}

}  // namespace simwright::twin
