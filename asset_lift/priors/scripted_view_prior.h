#pragma once

#include <filesystem>
#include <memory>

namespace simwright::asset_lift {

class ViewPrior;

// Loads a view prior from a TorchScript module, so that an exported Zero-1-to-3 can be used. The
// module has
//   forward(image, camera, noisy, t) -> noise
//     image   (B x 3 x S x S) in [-1, 1], the object over white; zeros: not conditioned
//     camera  (B x 4): elevation difference (rad, of the polar angle: down is positive), sine and
//             cosine of the azimuth difference, distance difference (m of Zero-1-to-3: 0 here);
//             zeros: not conditioned
//     noisy   (B x C x h x w)
//     t       (B) int64
//     noise   as noisy
// and may have
//   encode(picture) -> (B x C x h x w), from (B x 3 x S x S) in [-1, 1] over white: a latent model.
//     Without it C = 3 and h = w = S.
//   attributes `side` (S, default 64), `steps` (1000), `beta_first` (0.00085), `beta_last` (0.012).
// Throws core::Error, with the expected and the actual signature, where the file is no TorchScript
// or a trial call shows another signature.
std::shared_ptr<ViewPrior> LoadScriptedViewPrior(const std::filesystem::path& path);

}  // namespace simwright::asset_lift
