// gonio render: lit spheres of materials as a picture.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/gonio/command.h"
#include "apps/gonio/device_option.h"
#include "apps/gonio/lut_options.h"
#include "apps/gonio/progress.h"
#include "export/rgb.h"
#include "lut/table.h"
#include "material/evaluate.h"
#include "material/material_json.h"
#include "render/image_file.h"
#include "render/reflectance.h"
#include "render/sphere.h"

namespace gonio::app {
namespace {

struct RenderOptions {
  std::vector<std::string> materials;
  std::string output;
  render::SphereView view;
  std::vector<std::string> lights;
  std::string turn_deg;
  std::string exposure;
  int columns = 0;  // 0: all spheres in one row
  LutOptions table;
  std::string filter;         // of the table: linear or nearest; empty: linear
  std::string amplification;  // of the difference between table and model; empty: not shown
  std::string device;
  int threads = 0;
  bool json = false;
};

/// What a sphere is made of.
struct Shown {
  material::Material material;
  brdf::BoundModel model;
  exports::RgbChannels channels;
};

/// A sphere and, where both were rendered, how far the table is from the model at most: the
/// difference of radiance over the model's largest.
struct Sphere {
  render::Image image;
  std::optional<double> table_error;
};

/// The number of an option, `absent` if it is not given.
double number_of(std::string_view option, const std::string& text, double lowest, double highest,
                 double absent) {
  if (text.empty()) return absent;
  const auto number = parse_number(text);
  if (number && *number >= lowest && *number <= highest) return *number;
  throw std::invalid_argument(
      fmt::format("{} {}: expected a number of {:g} to {:g}", option, text, lowest, highest));
}

brdf::Direction<double> parse_light(std::string_view text) {
  const std::size_t comma = std::min(text.find(','), text.size());
  const auto theta = parse_number(text.substr(0, comma));
  const auto phi = parse_number(text.substr(std::min(comma + 1, text.size())));
  if (!theta || !phi || !(*theta >= 0 && *theta <= 180) || !std::isfinite(*phi)) {
    throw std::invalid_argument(fmt::format(
        "--light {}: expected THETA,PHI in degrees such as 40,120: theta 0 to 180, counted from "
        "the viewer, phi from the right towards the top",
        text));
  }
  return brdf::direction_from_degrees(*theta, *phi);
}

render::SphereView view_of(const RenderOptions& options) {
  render::SphereView view = options.view;
  if (!options.lights.empty()) view.lights.clear();
  for (const std::string& light : options.lights) view.lights.push_back(parse_light(light));
  view.turn = number_of("--turn", options.turn_deg, -360, 360, 0) * (std::numbers::pi / 180);
  return view;
}

/// Refuses options that would have no effect.
void check_table_options(const RenderOptions& options) {
  if (!options.table.table.empty()) return;
  const auto check = [](std::string_view option, const std::string& given, std::string_view hint) {
    if (given.empty()) return;
    throw std::invalid_argument(fmt::format(
        "{} {}: is about a look-up table, expected --table as well{}", option, given, hint));
  };
  check("--size", options.table.size, "; the picture's size is --pixels");
  check("--coordinate", options.table.coordinate, "");
  check("--reach", options.table.reach, "");
  check("--format", options.table.format, "");
  check("--difference", options.amplification, "");
  check("--filter", options.filter, "");
}

Shown read_shown(const std::string& path) {
  material::Material material = material::read_material(path);
  brdf::BoundModel model = material::bind(material);
  exports::RgbChannels channels = exports::rgb_channels(material);
  if (channels.is_invisible) {
    print_note(fmt::format("{}: {}: not all of them is visible light", path, channels.statement));
  }
  return {std::move(material), std::move(model), std::move(channels)};
}

/// Gives what is wrong with a material's table the material's path.
template <class Work>
auto with_path(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", path, error.what()));
  }
}

/// Renders one material after the other in the same view.
class Studio {
 public:
  explicit Studio(const RenderOptions& options)
      : options_(options),
        view_(view_of(options)),
        filter_(options.filter.empty() ? lut::Filter::linear : lut::filter_named(options.filter)),
        amplification_(number_of("--difference", options.amplification, 1e-3, 1e9, 1)),
        device_(choose_device(options.device)) {}

  const std::string& device() const { return device_.text; }

  Sphere render(const Shown& shown) {
    if (options_.table.table.empty()) return {by_model(shown), std::nullopt};
    const lut::Table table = lut::bake(layout_from(options_.table, &shown.model));
    if (options_.amplification.empty()) return {by_table(shown, table), std::nullopt};
    const render::Image with_table = by_table(shown, table);
    const render::Image with_model = by_model(shown);
    const double largest = render::largest_colour(with_model);
    const double apart = render::largest_colour(render::difference(with_table, with_model, 1));
    return {render::difference(with_table, with_model, amplification_),
            largest > 0 ? apart / largest : 0};
  }

 private:
  render::Image by_model(const Shown& shown) {
    const render::RgbChannels& channels = shown.channels.channel;
    const auto reflectance =
        device_.device ? render::device_reflectance(*device_.device, shown.model, channels)
                       : render::model_reflectance(shown.model, channels, options_.threads);
    return render::render_sphere(reflectance, view_);
  }

  render::Image by_table(const Shown& shown, const lut::Table& table) {
    const render::RgbChannels& channels = shown.channels.channel;
    if (device_.device) {
      return render::render_sphere(
          render::device_reflectance(*device_.device, shown.model, channels,
                                     shader::TableUse{table, filter_}),
          view_);
    }
    const lut::TableModel model(shown.model, table, filter_, lut::Weights::exact);
    return render::render_sphere(
        render::table_reflectance(model, shown.model.channel_count(), channels, options_.threads),
        view_);
  }

  const RenderOptions& options_;
  render::SphereView view_;
  lut::Filter filter_;
  double amplification_;
  ChosenDevice device_;
};

std::string name_of(const Shown& shown, const std::string& path) {
  return shown.material.name.empty() ? path : shown.material.name;
}

nlohmann::ordered_json json_of(const Shown& shown, const Sphere& sphere, const std::string& path) {
  nlohmann::ordered_json json{{"material", name_of(shown, path)},
                              {"model", shown.material.model},
                              {"channels", shown.channels.statement}};
  if (sphere.table_error) json["table_error"] = *sphere.table_error;
  return json;
}

std::string text_of(const Shown& shown, const Sphere& sphere, const std::string& path) {
  if (!sphere.table_error) return "";
  return fmt::format("  {}: the table errs by up to {:.2g} of the largest radiance\n",
                     name_of(shown, path), *sphere.table_error);
}

void render_materials(const RenderOptions& options) {
  const render::ImageFormat format = render::image_format_of(options.output);
  check_table_options(options);
  const double exposure = number_of("--exposure", options.exposure, -64, 64, 0);
  if (!options.exposure.empty() && format == render::ImageFormat::exr) {
    throw std::invalid_argument(fmt::format(
        "--exposure {}: is of a .png, expected none for {}, which holds radiance as it is",
        options.exposure, options.output));
  }
  for (const std::string& path : options.materials) refuse_overwriting(path, options.output);
  render::require_image_output(options.output);
  Studio studio(options);
  std::vector<render::Image> images;
  std::vector<std::string> names;
  std::vector<std::string> models;
  nlohmann::ordered_json spheres = nlohmann::ordered_json::array();
  std::string text;
  for (const std::string& path : options.materials) {
    const Shown shown = read_shown(path);
    Sphere sphere = [&] {
      const ProgressLine progress("rendering " + path);
      return with_path(path, [&] { return studio.render(shown); });
    }();
    names.push_back(name_of(shown, path));
    models.push_back(shown.material.model);
    spheres.push_back(json_of(shown, sphere, path));
    text += text_of(shown, sphere, path);
    images.push_back(std::move(sphere.image));
  }
  const int columns = options.columns > 0 ? options.columns : int(images.size());
  const render::Image image = render::sheet(images, columns);
  render::write_image(image, options.output, exposure,
                      {{"gonio:material", fmt::format("{}", fmt::join(names, "; "))},
                       {"gonio:model", fmt::format("{}", fmt::join(models, "; "))}});
  if (options.json) {
    print_json({{"image", options.output},
                {"width", image.width},
                {"height", image.height},
                {"device", studio.device()},
                {"spheres", spheres}});
    return;
  }
  print(fmt::format("{}: {} x {} pixels, evaluated by {}\n{}", options.output, image.width,
                    image.height, studio.device(), text));
}

void add_view_options(CLI::App& command, RenderOptions& options) {
  command
      .add_option("--pixels", options.view.size,
                  "Width and height of a sphere's picture (default 256)")
      ->check(CLI::Range(1, render::largest_sphere));
  command
      .add_option("--samples", options.view.samples, "Samples across a pixel and down (default 4)")
      ->check(CLI::Range(1, render::most_samples));
  command
      .add_option("--light", options.lights,
                  "Where a light is, in degrees: from the viewer, and from the right towards the "
                  "top (default 40,120); may be given again")
      ->type_name("THETA,PHI")
      ->expected(1)
      ->take_all();
  command
      .add_option("--turn", options.turn_deg,
                  "The angle from the sphere's parallels to the material's tangent")
      ->type_name("DEG");
  command
      .add_option("--exposure", options.exposure,
                  "Of a PNG: radiance is multiplied by 2^EV, and 1 is white (default 0)")
      ->type_name("EV");
  command.add_option("--columns", options.columns, "Spheres in a row (default: all of them)")
      ->check(CLI::Range(1, 1000));
}

void add_evaluation_options(CLI::App& command, RenderOptions& options) {
  add_lut_options(command, options.table);
  command
      .add_option("--filter", options.filter, "Of the look-up table: linear (default) or nearest")
      ->check(CLI::IsMember({"linear", "nearest"}))
      ->type_name("FILTER");
  command
      .add_option("--difference", options.amplification,
                  "Show |table - model| times X instead of the sphere")
      ->type_name("X");
  add_device_option(command, options.device);
  command
      .add_option("--threads", options.threads,
                  "Of the CPU; 0: all; the picture is the same for any")
      ->check(CLI::Range(0, 4096));
}

}  // namespace

void add_render_command(CLI::App& app, Invocation& /*invocation*/) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* command = app.add_subcommand(
      "render", "A picture of lit spheres of materials, by the model or a look-up table");
  command->add_option("MATERIAL", options->materials, "The materials (JSON), a sphere each")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "The picture: .exr for linear radiance, .png for a display")
      ->required()
      ->type_name("IMAGE");
  add_view_options(*command, *options);
  add_evaluation_options(*command, *options);
  command->add_flag("--json", options->json, "Print what was rendered as JSON");
  command->callback([options] { render_materials(*options); });
}

}  // namespace gonio::app
