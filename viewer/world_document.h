#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/json.h"
#include "viewer/document.h"

namespace simwright::viewer {

// A placed instance of a model.
struct WorldBody {
  std::string name;
  int model = 0;  // index in the manifest
  Eigen::Isometry3d world_from_root = Eigen::Isometry3d::Identity();
  bool fixed = false;
  // Positions of joints by name, rad or m; other joints are at the position nearest to zero.
  std::vector<std::pair<std::string, double>> positions = {};
};

// Returns the bodies as the manifest lists them.
core::OrderedJson BodiesJson(const std::vector<WorldBody>& bodies);

// The motion of bodies, sampled at a constant rate. Each frame is a row of `width` numbers; tracks
// and signals are columns of it.
struct Timeline {
  // The columns of one body: its pose, where it moves, as x, y, z (m) and the quaternion x, y, z,
  // w; and positions of joints.
  struct Track {
    int body = 0;
    int pose = -1;                    // first of 7 columns; -1: does not move
    std::vector<std::string> joints;  // names
    int joint_columns = 0;            // the first one
  };
  // A quantity over time.
  struct Signal {
    std::string name, unit;
    int column = 0;
  };
  // A named moment, such as the begin of a subtask.
  struct Mark {
    std::string name;
    int frame = 0;
  };

  std::string name;
  double rate = 60.0;  // frames per second
  int width = 0;
  std::vector<Track> tracks;
  std::vector<Signal> signals;
  std::vector<Mark> marks;
  // Columns of contact points: x, y, z (m) and the strength (0: no contact), 4 each.
  int contacts = 0, contact_columns = 0;
  std::vector<float> rows;  // (frames x width)
  Facts facts;

  int frames() const { return width > 0 ? static_cast<int>(rows.size()) / width : 0; }
};

// Returns the description of a timeline without its rows.
core::OrderedJson TimelineJson(const Timeline& timeline);
// Returns the rows as little-endian bytes.
std::string TimelineBytes(const Timeline& timeline);
// Adds the rows to `builder`; returns the description with the index `buffer`.
core::OrderedJson AddTimeline(const Timeline& timeline, DocumentBuilder* builder);

// Appends the 7 numbers of a pose to a row.
void AppendPose(const Eigen::Isometry3d& pose, std::vector<float>* row);

// A curve of a chart, such as the success rate over the samples of a training.
struct Curve {
  std::string name;
  std::vector<double> x, y;       // equal length; y may be NaN where it is not known
  std::vector<double> low, high;  // an interval around y, or empty
};
struct Chart {
  std::string title, x_name, y_name;
  std::vector<Curve> curves;
};
core::OrderedJson ChartJson(const Chart& chart);

}  // namespace simwright::viewer
