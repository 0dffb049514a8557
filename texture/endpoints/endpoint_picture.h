#pragma once

#include <string>

#include "core/image.h"
#include "texture/endpoints/endpoint_connection.h"
#include "texture/image_generator.h"

namespace simwright::texture {

// The place of a requested picture on the canvas that a server is asked for: servers make pictures
// of few sizes, so that a view is padded and the answer cropped.
struct Canvas {
  int width = 0, height = 0;                  // of the canvas, pixels
  int left = 0, top = 0;                      // of the picture on it
  int picture_width = 0, picture_height = 0;  // of the picture, pixels
  bool padded() const { return width != picture_width || height != picture_height; }
};

// Returns the size of the picture that a request asks for, on a canvas whose sides are multiples of
// `multiple`.
Canvas CanvasOf(const ImageRequest& request, int multiple);
// Returns the smallest canvas of the given aspect ratio around the picture.
Canvas CanvasOfAspect(const ImageRequest& request, int aspect_width, int aspect_height);

// Return the views of a request with a render, padded to the canvas: the render, with its edge
// pixels repeated; the inpainting mask (255: repaint, 0: keep), 0 in the margin; and the depth as
// ControlNet's depth models read it, RGB with 255 at the nearest point, falling linearly in inverse
// depth to 64 at the farthest one, 0 where there is nothing.
core::Image PaddedRender(const ImageRequest& request, const Canvas& canvas);
core::Image InpaintingMask(const ImageRequest& request, const Canvas& canvas);
core::Image InverseDepthPicture(const ImageRequest& request, const Canvas& canvas);

// Decodes an answer to the RGB picture that was asked for. A picture of another size is resized,
// with the finding "image-resized"; transparency is put on white. Fails if the bytes are no
// picture, if a view has another aspect ratio than the canvas, and if all pixels have one colour,
// as the pictures of content filters and of numerical faults have. A picture of words alone with
// another aspect ratio is cropped at its centre, with the finding "image-cropped".
core::Image AnsweredPicture(const std::string& bytes, const ImageRequest& request,
                            const Canvas& canvas, EndpointConnection* connection);

}  // namespace simwright::texture
