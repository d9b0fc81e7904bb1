// SPDX-License-Identifier: MIT
#include "tools/drawing/picture_file.h"

#include <cmath>
#include <memory>

#include <cairo-svg.h>

#include "tools/support/output_file.h"

namespace camway::draw {
namespace {

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;
/// Pixels of a PNG file for one of the picture, so that letters stay sharp when it is enlarged.
constexpr double kPngScale = 2.0;

using Drawing = std::function<void(cairo_t*)>;

/// Draws on `surface`. Returns cairo's error text, empty on success.
std::string draw_on(cairo_surface_t* surface, const Drawing& draw) {
  const Context context(cairo_create(surface), &cairo_destroy);
  cairo_set_source_rgb(context.get(), 1.0, 1.0, 1.0);
  cairo_paint(context.get());
  draw(context.get());
  cairo_show_page(context.get());
  const cairo_status_t status = cairo_status(context.get());
  return status == CAIRO_STATUS_SUCCESS ? "" : cairo_status_to_string(status);
}

/// Write function for cairo that appends to a `std::string`.
cairo_status_t append(void* picture, const unsigned char* bytes, unsigned size) {
  static_cast<std::string*>(picture)->append(reinterpret_cast<const char*>(bytes), size);
  return CAIRO_STATUS_SUCCESS;
}

std::string write_picture(const std::filesystem::path& file, const std::string& reason,
                          const std::string& picture) {
  if (!reason.empty()) return file.string() + ": cannot be drawn: " + reason;
  return tools::write_file(file, picture);
}

/// Draws into `picture`. Returns why that is not possible; empty on success.
std::string draw_svg(const PictureSize& size, const Drawing& draw, std::string& picture) {
  const Surface surface(
      cairo_svg_surface_create_for_stream(&append, &picture, size.width_px, size.height_px),
      &cairo_surface_destroy);
  std::string reason = draw_on(surface.get(), draw);
  cairo_surface_finish(surface.get());
  const cairo_status_t status = cairo_surface_status(surface.get());
  if (reason.empty() && status != CAIRO_STATUS_SUCCESS) reason = cairo_status_to_string(status);
  return reason;
}

std::string write_svg(const std::filesystem::path& file, const PictureSize& size,
                      const Drawing& draw) {
  std::string picture;
  const std::string reason = draw_svg(size, draw, picture);
  return write_picture(file, reason, picture);
}

std::string draw_png(const std::filesystem::path& file, const PictureSize& size,
                     const Drawing& draw) {
  const Surface surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24,
                                 static_cast<int>(std::ceil(kPngScale * size.width_px)),
                                 static_cast<int>(std::ceil(kPngScale * size.height_px))),
      &cairo_surface_destroy);
  cairo_surface_set_device_scale(surface.get(), kPngScale, kPngScale);
  std::string picture;
  std::string reason = draw_on(surface.get(), draw);
  const cairo_status_t status = cairo_surface_write_to_png_stream(surface.get(), &append, &picture);
  if (reason.empty() && status != CAIRO_STATUS_SUCCESS) reason = cairo_status_to_string(status);
  return write_picture(file, reason, picture);
}

}  // namespace

std::string write_pictures(const PictureFiles& files, const PictureSize& size,
                           const Drawing& draw) {
  std::string error;
  if (!files.svg.empty()) error = write_svg(files.svg, size, draw);
  if (error.empty() && !files.png.empty()) error = draw_png(files.png, size, draw);
  return error;
}

std::string svg_picture(const PictureSize& size, const Drawing& draw) {
  std::string picture;
  return draw_svg(size, draw, picture).empty() ? picture : std::string();
}

}  // namespace camway::draw
