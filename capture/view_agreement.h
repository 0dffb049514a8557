#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "capture/capture.h"
#include "capture/voting_hull.h"
#include "core/float_image.h"

namespace simwright::capture {

// Returns the masks that show something, with the share of them that may be wrong. `open`: one
// image per view (H x W x 1), 1 where its mask excludes nothing; one that is empty, or no images:
// masks count everywhere.
HullVote VoteOf(const std::vector<CaptureView>& views, double tolerated,
                const std::vector<core::FloatImage>& open);

// Returns the hull of the votes in a box (m) with `cells` along its longest side, grown by `margin`
// cells, flat on z = 0; empty if nothing is inside or a vote has too few masks.
core::TriangleMesh HullOf(const std::vector<HullVote>& votes, const Eigen::AlignedBox3d& box,
                          int cells, double margin);

// Returns the intersection of two masks over their union.
double MaskIou(const core::FloatImage& a, const core::FloatImage& b);

// Returns the box grown on all sides by 6 % of its diagonal.
Eigen::AlignedBox3d Grown(Eigen::AlignedBox3d box);

// Leaves out the views whose masks and hull disagree, with a finding each. Throws core::Error if
// less than half of the views or fewer than four remain.
void LeaveOutContradictions(const CaptureSource& source, Capture* capture);

// Adds the findings of MissingViews.
void AdviseMorePhotos(Capture* capture);

}  // namespace simwright::capture
