#include "asset_lift/priors/scripted_view_prior.h"

#include <cmath>
#include <sstream>

#include "asset_lift/priors/view_prior.h"
#include "core/error.h"
#include "nn/compute.h"
#include "nn/torch_script.h"

namespace simwright::asset_lift {
namespace {

// Returns the first line of libtorch's message; the rest is its stack.
std::string FirstLine(const std::string& text) {
  return text.substr(0, std::min(text.find('\n'), static_cast<size_t>(200)));
}

std::string Shape(const torch::Tensor& tensor) {
  std::ostringstream text;
  text << tensor.sizes();
  return text.str();
}

// Returns the crop of an image as (1 x 3 x side x side) in [-1, 1], over white.
torch::Tensor OverWhite(const ReferenceView& reference, int side) {
  const ObservedView view = CropView(reference.photo, reference.alpha, reference.frame, side);
  torch::Tensor picture = torch::empty({1, 3, side, side});
  auto at = picture.accessor<float, 4>();
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const float share = view.opacity.At(x, y)[0];
      for (int c = 0; c < 3; ++c) {
        at[0][c][y][x] = share * (2.0f * view.color.At(x, y)[c] - 1.0f) + (1.0f - share);
      }
    }
  }
  return picture;
}

class ScriptedViewPrior : public ViewPrior {
 public:
  ScriptedViewPrior(torch::jit::script::Module module, const std::string& where)
      : module_(std::move(module)),
        where_(where),
        device_(nn::BestDevice()),
        side_(static_cast<int>(Number("side", 64))),
        schedule_(nn::DiffusionSchedule::ScaledLinear(static_cast<int>(Number("steps", 1000)),
                                                      Number("beta_first", 0.00085),
                                                      Number("beta_last", 0.012))) {
    if (side_ < 8 || side_ > 4096) {
      throw core::Error("its `side` is " + std::to_string(side_) + ", expected 8 to 4096", where_);
    }
    module_.eval();
    module_.to(device_);
    encodes_ = module_.find_method("encode").has_value();
    image_ = torch::zeros({1, 3, side_, side_}, device_);
    TryOut();
  }

  int side() const override { return side_; }
  const nn::DiffusionSchedule& schedule() const override { return schedule_; }

  void SetReference(const ReferenceView& view) override {
    reference_ = view.frame.camera;
    image_ = OverWhite(view, side_).to(device_);
  }

  torch::Tensor Encode(const torch::Tensor& pictures) override {
    const torch::Tensor moved = pictures.to(device_);
    const torch::Tensor white = 2.0 * (moved.slice(1, 0, 3) + 1.0 - moved.slice(1, 3, 4)) - 1.0;
    if (!encodes_) return white;
    return Tensor(module_.get_method("encode")({white}), "encode");
  }

  torch::Tensor PredictNoise(const torch::Tensor& noisy, const torch::Tensor& t,
                             const std::vector<core::Camera>& cameras, bool conditioned) override {
    const auto batch = noisy.size(0);
    torch::Tensor image = torch::zeros({batch, 3, side_, side_}, device_);
    torch::Tensor camera = torch::zeros({batch, 4});
    if (conditioned) {
      image = image_.expand({batch, 3, side_, side_});
      for (std::int64_t i = 0; i < batch; ++i) {
        const RelativeCamera r = RelativeTo(reference_, cameras[static_cast<size_t>(i)]);
        // Zero-1-to-3 measures the polar angle from the zenith and the azimuth clockwise.
        camera[i] = torch::tensor({-r.elevation, std::sin(-r.azimuth), std::cos(-r.azimuth), 0.0},
                                  torch::kFloat);
      }
    }
    return Tensor(module_.forward({image, camera.to(device_), noisy, t.to(device_)}), "forward");
  }

 private:
  double Number(const char* name, double otherwise) const {
    if (!module_.hasattr(name)) return otherwise;
    const c10::IValue value = module_.attr(name);
    if (value.isInt()) return static_cast<double>(value.toInt());
    if (value.isDouble()) return value.toDouble();
    throw core::Error(std::string("its attribute `") + name + "` is not a number", where_);
  }

  torch::Tensor Tensor(const c10::IValue& value, const char* method) const {
    if (value.isTensor()) return value.toTensor();
    throw core::Error(
        std::string("its ") + method + " returns " + value.tagKind() + ", expected a tensor",
        where_);
  }

  // Makes one call on zeros, so that a wrong signature fails before a reconstruction has run for
  // minutes.
  void TryOut() {
    const char* expected =
        "expected forward(image [B,3,S,S], camera [B,4], noisy [B,C,h,w], t [B] int64) -> noise "
        "[B,C,h,w], and encode(picture [B,3,S,S]) -> [B,C,h,w] for a latent model";
    const torch::NoGradGuard no_grad;
    try {
      const torch::Tensor latent = Encode(torch::zeros({1, 4, side_, side_}));
      const torch::Tensor noise =
          PredictNoise(latent, torch::zeros({1}, torch::kLong), {core::Camera{}}, false);
      if (noise.sizes() != latent.sizes()) {
        throw core::Error("returns noise of shape " + Shape(noise) + " for " + Shape(latent),
                          where_, expected);
      }
    } catch (const core::Error&) {
      throw;
    } catch (const std::exception& error) {
      throw core::Error("its trial call failed: " + FirstLine(error.what()), where_, expected);
    }
  }

  torch::jit::script::Module module_;
  std::string where_;
  torch::Device device_;
  int side_;
  nn::DiffusionSchedule schedule_;
  bool encodes_ = false;
  core::Camera reference_;
  torch::Tensor image_;
};

}  // namespace

std::shared_ptr<ViewPrior> LoadScriptedViewPrior(const std::filesystem::path& path) {
  return std::make_shared<ScriptedViewPrior>(nn::LoadTorchScript(path), path.string());
}

}  // namespace simwright::asset_lift
