// SampleTable: what was measured, as a structure of arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/direction.h"

namespace gonio::table {

/// Why a sample takes no part in anything; `none` means that it does.
enum class MaskReason : std::uint8_t {
  none,
  horizon,       // a direction within 1e-6 deg of the horizon, or below it
  hole,          // no channel was measured
  extrapolated,  // written by the instrument's software where it did not measure
  padding,       // zeros that fill the file's grid beyond what was measured
  retro,         // so near retro-reflection that the instrument shades its own beam
  blind_spot,    // a viewing direction that the user says the instrument cannot see
};
inline constexpr std::size_t mask_reason_count = 7;
std::string_view name(MaskReason reason);
/// The reason of that name; nothing if there is none.
std::optional<MaskReason> mask_reason_named(std::string_view name);

/// What the numbers of a file are; a SampleTable always holds f_r, whatever the file declared.
enum class Quantity : std::uint8_t { brdf, brdf_cos, reflectance_factor };
std::string_view name(Quantity quantity);

enum class AngleUnit : std::uint8_t { degrees, radians };
std::string_view name(AngleUnit unit);

/// Unit vectors, one per sample, as a structure of arrays.
struct DirectionArray {
  std::vector<double> x, y, z;

  std::size_t size() const { return x.size(); }
  void resize(std::size_t count);
  brdf::Direction<double> operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void push_back(const brdf::Direction<double>& d);
  void set(std::size_t i, const brdf::Direction<double>& d);
};

/// Where a table came from.
struct Provenance {
  std::string path;
  std::string format;  // "gonio-table 1", "ASTM text", "virtual gonioreflectometer"
  std::string sha256;  // of the file's bytes, lower-case hexadecimal; empty if it was no file
  Quantity quantity = Quantity::brdf;
  AngleUnit angles = AngleUnit::degrees;
};

struct SampleTable {
  std::string name;
  std::vector<std::string> channels;
  DirectionArray wi, wo;
  /// f_r in 1/sr, [channel][sample]. A quiet NaN is a hole: this channel was not measured.
  std::vector<std::vector<double>> values;
  /// The standard deviation of each value in 1/sr, [channel][sample]; empty if not known.
  std::vector<std::vector<double>> sigma;
  /// A weight per sample, at least 0; empty if the table carries none.
  std::vector<double> weight;
  /// The weights are the solid angles that the samples of a grid stand for, but for one factor.
  bool weight_is_solid_angle = false;
  /// One reason per sample.
  std::vector<MaskReason> mask;
  /// With ReadOptions::keep_angle_text: "theta_i,phi_i,theta_o,phi_o" of each row as the file
  /// wrote them, in the unit of provenance.angles. Else empty.
  std::vector<std::string> angle_text;
  /// The format has no azimuth of the sample: one stands for all, and what looks anisotropic is
  /// not.
  bool takes_isotropy = false;
  /// What the reader has to tell the user, one sentence each.
  std::vector<std::string> notes;
  Provenance provenance;

  std::size_t size() const { return mask.size(); }
  bool has_sigma() const { return !sigma.empty(); }
  bool has_weight() const { return !weight.empty(); }
};

/// Incidence angles from `lower_deg` to below `upper_deg`: the samples inside, or the others.
struct IncidenceBand {
  double lower_deg;
  double upper_deg;
  bool inside;
};

/// True where sample `i` is not masked, has no weight of 0, both polar angles are at most
/// `max_theta_deg` (inclusive, + 1e-6 deg), and the incidence angle is where the band wants it.
class SampleFilter {
 public:
  SampleFilter(const SampleTable& table, double max_theta_deg,
               const std::optional<IncidenceBand>& incidence = {});
  bool operator()(std::size_t i) const {
    return table_->mask[i] == MaskReason::none && table_->wi.z[i] >= min_cos_ &&
           table_->wo.z[i] >= min_cos_ && (table_->weight.empty() || table_->weight[i] > 0) &&
           (!has_band_ || in_band(table_->wi.z[i]));
  }

 private:
  bool in_band(double cos_i) const {
    return (cos_i <= band_max_cos_ && cos_i > band_min_cos_) == inside_;
  }

  const SampleTable* table_;
  double min_cos_;
  bool has_band_;
  bool inside_ = true;
  double band_min_cos_ = 0;
  double band_max_cos_ = 1;
};

}  // namespace gonio::table
