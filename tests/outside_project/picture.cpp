// What a project that uses gonio's tables and pictures looks like: the lobe of a table as a row of
// grey pixels.
#include <array>
#include <vector>

#include "lut/table.h"
#include "render/image_file.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  gonio::lut::Layout layout{
      .kind = gonio::lut::TableKind::ward_lobe, .lowest = 0.2, .highest = 0.2};
  layout.reach = gonio::lut::lobe_reach(layout);
  const gonio::lut::Table table = gonio::lut::bake(layout);
  gonio::render::Image image;
  image.width = 64;
  image.height = 1;
  for (int x = 0; x < image.width; ++x) {
    const double w = layout.reach * x / image.width;
    const auto lobe =
        float(gonio::lut::look_up(table, w, layout.lowest, gonio::lut::Filter::linear)[0]);
    if (x == 0 && lobe != 1) return 1;  // the peak is a texel
    image.pixels.push_back({lobe, lobe, lobe, 1});
  }
  gonio::render::write_image(image, argv[1]);
}
