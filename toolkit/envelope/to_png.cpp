#include <png.h>

#include "taut/core/error.h"
#include "taut/envelope/envelope_picture.h"

namespace taut {

std::string to_png(const Picture& picture) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = png_uint_32(picture.width);
  image.height = png_uint_32(picture.height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string result(bytes, '\0');
  const int written = png_image_write_to_memory(&image, result.data(), &bytes, 0,
                                                picture.pixels.data(), 0, nullptr);
  const std::string message = image.message;
  png_image_free(&image);
  if (written == 0) throw BackendError("libpng: " + message);
  result.resize(bytes);
  return result;
}

}  // namespace taut
