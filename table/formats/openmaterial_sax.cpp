#include "table/formats/openmaterial_sax.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "table/file_error.h"

namespace gonio::table {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double largest_zenith = std::numbers::pi / 2 * (1 + 1e-6 / 90);
constexpr double largest_azimuth = 2 * std::numbers::pi + 1e-6;
constexpr double shortest_wavelength = 1e-9;
constexpr double longest_wavelength = 17.16e-3 * (1 + 1e-9);

bool is_wavelength(double value) {
  return value >= shortest_wavelength && value <= longest_wavelength;
}

std::string line_and_column(std::string_view content, std::size_t offset) {
  const std::string_view before = content.substr(0, std::min(offset, content.size()));
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
  return fmt::format("line {}, column {}", line, before.size() - line_start + 1);
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return (c >= '\0' && c < ' ') || c == '\x7f'; }, ' ');
  return text;
}

/// Where in the document the parser is.
enum class Place : std::uint8_t { outside, root, metadata, brdf, wavelengths, lookup_table, row };

/// What nlohmann's parser calls for each piece of the text.
class Handler {
 public:
  Handler(std::string_view content, const std::string& path) : content_(content), path_(path) {}

  OpenMaterialText take() {
    if (!has_wavelengths_) refuse("/brdf/wavelengths", "missing: add the list of wavelengths");
    if (!has_table_) refuse("/brdf/lookupTable", "missing: add the rows of the table");
    if (text_.rows.empty()) {
      refuse("/brdf/lookupTable", "found no row, expected one at least: add the table's rows");
    }
    return std::move(text_);
  }

  bool null() { return scalar("null", nan, true); }
  bool boolean(bool value) { return scalar(value ? "true" : "false", nan, false); }
  bool number_integer(std::int64_t value) { return number(static_cast<double>(value)); }
  bool number_unsigned(std::uint64_t value) { return number(static_cast<double>(value)); }
  bool number_float(double value, const std::string& /*text*/) { return number(value); }
  bool binary(std::vector<std::uint8_t>& /*value*/) { return scalar("bytes", nan, false); }

  bool string(std::string& value) {
    if (skipped_ == 0 && place_ == Place::metadata && key_ == "name") {
      text_.name = one_line(std::move(value));
      return true;
    }
    return scalar("a text", nan, false);
  }

  bool key(std::string& name) {
    if (skipped_ > 0) return true;
    key_ = std::move(name);
    if (place_ == Place::root) require_first(has_brdf_, "brdf", "/brdf");
    if (place_ == Place::root) require_first(has_metadata_, "metadata", "/metadata");
    if (place_ == Place::brdf) require_first(has_table_, "lookupTable", "/brdf/lookupTable");
    if (place_ == Place::brdf) require_first(has_wavelengths_, "wavelengths", "/brdf/wavelengths");
    return true;
  }

  bool start_object(std::size_t /*size*/) {
    if (skipped_ > 0) {
      ++skipped_;
    } else if (place_ == Place::outside) {
      place_ = Place::root;
    } else if (place_ == Place::root && key_ == "metadata") {
      place_ = Place::metadata;
    } else if (place_ == Place::root && key_ == "brdf") {
      place_ = Place::brdf;
    } else {
      refuse_unless_ignored("an object");
      ++skipped_;
    }
    return true;
  }

  bool end_object() {
    if (skipped_ > 0) {
      --skipped_;
    } else {
      place_ = place_ == Place::root ? Place::outside : Place::root;
    }
    return true;
  }

  bool start_array(std::size_t /*size*/) {
    if (skipped_ > 0) {
      ++skipped_;
    } else if (place_ == Place::brdf && key_ == "wavelengths") {
      place_ = Place::wavelengths;
    } else if (place_ == Place::brdf && key_ == "lookupTable") {
      place_ = Place::lookup_table;
    } else if (place_ == Place::lookup_table) {
      place_ = Place::row;
      count_ = 0;
    } else {
      refuse_unless_ignored("an array");
      ++skipped_;
    }
    return true;
  }

  bool end_array() {
    if (skipped_ > 0) {
      --skipped_;
    } else if (place_ == Place::row) {
      finish_row();
      place_ = Place::lookup_table;
    } else {
      place_ = Place::brdf;
    }
    return true;
  }

  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const nlohmann::detail::exception& error) {
    constexpr int number_overflow = 406;
    const std::string place = line_and_column(content_, position == 0 ? 0 : position - 1);
    if (error.id == number_overflow) {
      refuse(place, "found a number that is too large for a double: correct it");
    }
    refuse(place, "the text is no JSON here, expected a whole JSON document: correct the file");
  }

 private:
  [[noreturn]] void refuse(std::string_view place, std::string_view problem) const {
    throw FileError(fmt::format("{}: {}: {}", path_, place, problem));
  }

  [[noreturn]] void refuse_row(std::string_view problem) const {
    refuse(fmt::format("/brdf/lookupTable/{}", text_.rows.size()), problem);
  }

  void require_first(bool& has, std::string_view name, std::string_view pointer) const {
    if (key_ != name) return;
    if (has) refuse(pointer, "stands twice, expected it once: remove one of them");
    has = true;
  }

  bool number(double value) { return scalar("a number", value, true); }

  bool scalar(std::string_view found, double value, bool is_number_or_null) {
    if (skipped_ > 0) return true;
    if (place_ == Place::row && is_number_or_null) {
      if (count_ < fields_.size()) fields_[count_] = value;
      ++count_;
    } else if (place_ == Place::wavelengths && is_wavelength(value)) {
      text_.wavelengths.push_back(value);
    } else {
      refuse_unless_ignored(std::isnan(value) ? std::string(found) : fmt::format("{}", value));
    }
    return true;
  }

  /// For a value where there is no use for it.
  void refuse_unless_ignored(std::string_view found) const {
    switch (place_) {
      case Place::outside:
        refuse("the document", fmt::format("found {}, expected an object", found));
      case Place::root:
        if (key_ == "brdf") refuse("/brdf", fmt::format("found {}, expected an object", found));
        return;
      case Place::metadata:
        return;
      case Place::brdf:
        if (key_ == "wavelengths" || key_ == "lookupTable") {
          refuse("/brdf/" + key_, fmt::format("found {}, expected an array", found));
        }
        return;
      case Place::wavelengths:
        refuse(
            fmt::format("/brdf/wavelengths/{}", text_.wavelengths.size()),
            fmt::format("found {}, expected a wavelength in metres, 1e-9 to 17.16e-3: correct it",
                        found));
      case Place::lookup_table:
        refuse_row(fmt::format("found {}, expected a row of 5 numbers: correct it", found));
      case Place::row:
        refuse_row(
            fmt::format("found {} as number {} of the row, expected a number or null: "
                        "correct it",
                        found, count_ + 1));
    }
  }

  void finish_row() {
    if (count_ != fields_.size()) {
      refuse_row(
          fmt::format("found {} numbers, expected 5: wavelength, incident zenith, exit "
                      "zenith, exit azimuth, f_r: complete the row",
                      count_));
    }
    OpenMaterialRow row{.wavelength = fields_[0],
                        .theta_i = fields_[1],
                        .theta_o = fields_[2],
                        .phi = fields_[3],
                        .f_r = fields_[4]};
    if (!std::isnan(row.wavelength) && !is_wavelength(row.wavelength)) {
      refuse_row(
          fmt::format("found the wavelength {}, expected metres, 1e-9 to 17.16e-3: correct "
                      "it",
                      row.wavelength));
    }
    require_zenith(row.theta_i, "incident");
    require_zenith(row.theta_o, "exit");
    if (row.theta_i == 0 || row.theta_o == 0) {
      if (std::isnan(row.phi)) row.phi = 0;
    }
    require_azimuth(row.phi);
    text_.rows.push_back(row);
  }

  void require_zenith(double theta, std::string_view which) const {
    if (theta >= 0 && theta <= largest_zenith) return;
    if (std::isnan(theta)) {
      refuse_row(
          fmt::format("the {} zenith is null, so that the direction is unknown, expected "
                      "radians: write the angle that was measured at",
                      which));
    }
    refuse_row(fmt::format("found the {} zenith {}, expected radians, 0 to pi/2: correct it", which,
                           theta));
  }

  void require_azimuth(double phi) const {
    if (phi >= 0 && phi <= largest_azimuth) return;
    if (std::isnan(phi)) {
      refuse_row(
          "the exit azimuth is null, so that the direction is unknown, expected radians: write the "
          "azimuth that was measured at, 0 towards the light, pi on the side of the mirror "
          "direction");
    }
    refuse_row(
        fmt::format("found the exit azimuth {}, expected radians, 0 to 2 pi: correct it", phi));
  }

  std::string_view content_;
  const std::string& path_;
  OpenMaterialText text_;
  Place place_ = Place::outside;
  std::size_t skipped_ = 0;  // how deep within something that is of no use
  std::string key_;
  std::array<double, 5> fields_{};
  std::size_t count_ = 0;  // numbers of the row so far
  bool has_metadata_ = false;
  bool has_brdf_ = false;
  bool has_wavelengths_ = false;
  bool has_table_ = false;
};

}  // namespace

OpenMaterialText parse_openmaterial(std::string_view content, const std::string& path) {
  Handler handler(content, path);
  nlohmann::json::sax_parse(content, &handler);
  return handler.take();
}

}  // namespace gonio::table
