#include "render/rigid_render.h"

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "render/packet_shading.h"

namespace simwright::render {
namespace {

constexpr int kTileSide = 4;
static_assert(kTileSide * kTileSide == kPacket);

void RequireImage(const core::Camera& camera, const RigidRenderOptions& options) {
  if (camera.width < 1 || camera.height < 1 || options.samples_per_side < 1) {
    throw core::Error("an image needs at least one pixel and one sample per pixel");
  }
}

// Returns the position within a pixel of sample N/2 of N.
float MiddleShift(int samples) {
  const int middle = samples / 2;
  return (static_cast<float>(middle) + 0.5f) / static_cast<float>(samples);
}

// Draws the tiles of one image.
class TileRow {
 public:
  TileRow(const SeenScene& seen, const core::Camera& camera, const ImageBuffers& buffers,
          const RigidRenderOptions& options)
      : seen_(seen),
        width_(camera.width),
        height_(camera.height),
        buffers_(buffers),
        samples_(buffers.rgb != nullptr ? options.samples_per_side : 1),
        // Without colours the representative ray alone is traced, where it is with them.
        shift_(MiddleShift(options.samples_per_side)) {}

  void Draw(int row) const {
    for (int x = 0; x < width_; x += kTileSide) DrawTile(x, row * kTileSide);
  }

 private:
  void Place(int x0, int y0, float dx, float dy, PacketPixels* pixels) const {
    for (int k = 0; k < kPacket; ++k) {
      const int x = x0 + k % kTileSide, y = y0 + k / kTileSide;
      pixels->x[k] = static_cast<float>(x) + dx;
      pixels->y[k] = static_cast<float>(y) + dy;
      pixels->valid[k] = x < width_ && y < height_ ? -1 : 0;
    }
  }

  void Trace(int x0, int y0, const PacketPixels& pixels, PacketHits* hits) const {
    IntersectBackdrop(seen_, pixels, hits);
    for (std::size_t p = 0; p < seen_.parts.size(); ++p) {
      const SeenPart& part = seen_.parts[p];
      if (part.x0 >= x0 + kTileSide || part.x1 <= x0 || part.y0 >= y0 + kTileSide ||
          part.y1 <= y0) {
        continue;
      }
      if (part.nearest >= *std::max_element(hits->depth, hits->depth + kPacket)) break;
      part.mesh->tree.Intersect(part.rays, pixels, static_cast<int>(p), hits);
    }
  }

  void DrawTile(int x0, int y0) const {
    PacketPixels pixels;
    PacketHits hits;
    PacketSurface surface;
    alignas(64) float sum[3][kPacket] = {};
    for (int j = 0; j < samples_; ++j) {
      for (int i = 0; i < samples_; ++i) {
        const bool representative = i == samples_ / 2 && j == samples_ / 2;
        const auto offset = [&](int step) {
          return (static_cast<float>(step) + 0.5f) / static_cast<float>(samples_);
        };
        const bool alone = buffers_.rgb == nullptr;
        Place(x0, y0, alone ? shift_ : offset(i), alone ? shift_ : offset(j), &pixels);
        Trace(x0, y0, pixels, &hits);
        if (buffers_.rgb != nullptr || buffers_.normal != nullptr) {
          EvaluateSurface(seen_, pixels, hits, buffers_.rgb != nullptr, &surface);
        }
        if (representative) Keep(x0, y0, hits, surface);
        if (buffers_.rgb == nullptr) continue;
        Illuminate(seen_, pixels, hits, &surface);
        for (int c = 0; c < 3; ++c) {
          for (int k = 0; k < kPacket; ++k) sum[c][k] += surface.albedo[c][k];
        }
      }
    }
    if (buffers_.rgb != nullptr) StoreColors(x0, y0, sum);
  }

  template <typename Body>
  void ForPixels(int x0, int y0, const Body& body) const {
    const int columns = std::min(kTileSide, width_ - x0), rows = std::min(kTileSide, height_ - y0);
    for (int j = 0; j < rows; ++j) {
      const std::size_t start =
          static_cast<std::size_t>(y0 + j) * static_cast<std::size_t>(width_) +
          static_cast<std::size_t>(x0);
      for (int i = 0; i < columns; ++i) {
        body(j * kTileSide + i, start + static_cast<std::size_t>(i));
      }
    }
  }

  void Keep(int x0, int y0, const PacketHits& hits, const PacketSurface& surface) const {
    ForPixels(x0, y0, [&](int k, std::size_t at) {
      const int code = hits.part[k];
      if (buffers_.depth != nullptr) buffers_.depth[at] = code == kNoHit ? 0.0f : hits.depth[k];
      if (buffers_.label != nullptr) buffers_.label[at] = LabelOf(code);
      if (buffers_.normal == nullptr) return;
      for (std::size_t c = 0; c < 3; ++c) buffers_.normal[3 * at + c] = surface.normal[c][k];
    });
  }

  std::int32_t LabelOf(int code) const {
    if (code >= 0) {
      return seen_.scene->part(seen_.parts[static_cast<std::size_t>(code)].index).label;
    }
    return code == kNoHit ? -1 : seen_.scene->backdrop->label;
  }

  void StoreColors(int x0, int y0, const float (*sum)[kPacket]) const {
    const float share = 1.0f / static_cast<float>(samples_ * samples_);
    ForPixels(x0, y0, [&](int k, std::size_t at) {
      for (std::size_t c = 0; c < 3; ++c) {
        buffers_.rgb[3 * at + c] = TabulatedByte(share * sum[c][k]);
      }
    });
  }

  const SeenScene& seen_;
  int width_, height_;
  const ImageBuffers& buffers_;
  int samples_;
  float shift_;
};

}  // namespace

void RenderRigid(const RigidScene& scene, const core::Camera& camera, const ImageBuffers& buffers,
                 const RigidRenderOptions& options) {
  RequireImage(camera, options);
  if (buffers.empty()) return;
  thread_local SeenScene memory;  // keeps its memory from image to image
  SeenScene& seen = memory;
  seen.See(scene, camera);
  const TileRow renderer(seen, camera, buffers, options);
  const int rows = (camera.height + kTileSide - 1) / kTileSide;
  core::ParallelFor(rows, [&renderer](int row) { renderer.Draw(row); });
}

void RenderRigidBatch(const std::vector<RigidView>& views, const RigidRenderOptions& options) {
  for (const RigidView& view : views) RequireImage(view.camera, options);
  const auto render = [&](const RigidView& view) {
    RenderRigid(*view.scene, view.camera, view.buffers, options);
  };
  // Few images are distributed by their rows, many as a whole.
  if (static_cast<int>(views.size()) < core::ThreadCount()) {
    for (const RigidView& view : views) render(view);
    return;
  }
  core::ParallelFor(static_cast<int>(views.size()),
                    [&](int i) { render(views[static_cast<std::size_t>(i)]); });
}

}  // namespace simwright::render
