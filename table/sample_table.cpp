#include "table/sample_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gonio::table {

std::string_view name(MaskReason reason) {
  switch (reason) {
    case MaskReason::none:
      return "none";
    case MaskReason::horizon:
      return "horizon";
    case MaskReason::hole:
      return "hole";
    case MaskReason::extrapolated:
      return "extrapolated";
    case MaskReason::padding:
      return "padding";
    case MaskReason::retro:
      return "retro";
    case MaskReason::blind_spot:
      return "blind-spot";
  }
  return "";
}

std::optional<MaskReason> mask_reason_named(std::string_view text) {
  for (std::size_t i = 0; i < mask_reason_count; ++i) {
    const auto reason = static_cast<MaskReason>(i);
    if (name(reason) == text) return reason;
  }
  return std::nullopt;
}

std::string_view name(Quantity quantity) {
  switch (quantity) {
    case Quantity::brdf:
      return "brdf";
    case Quantity::brdf_cos:
      return "brdf_cos";
    case Quantity::reflectance_factor:
      return "reflectance_factor";
  }
  return "";
}

std::string_view name(AngleUnit unit) { return unit == AngleUnit::degrees ? "deg" : "rad"; }

void DirectionArray::resize(std::size_t count) {
  x.resize(count);
  y.resize(count);
  z.resize(count);
}

void DirectionArray::push_back(const brdf::Direction<double>& d) {
  x.push_back(d.x);
  y.push_back(d.y);
  z.push_back(d.z);
}

void DirectionArray::set(std::size_t i, const brdf::Direction<double>& d) {
  x[i] = d.x;
  y[i] = d.y;
  z[i] = d.z;
}

SampleFilter::SampleFilter(const SampleTable& table, double max_theta_deg,
                           const std::optional<IncidenceBand>& incidence)
    : table_(&table),
      min_cos_(std::cos(std::min(max_theta_deg + 1e-6, 90.0) * std::numbers::pi / 180)),
      has_band_(incidence.has_value()) {
  if (!incidence) return;
  inside_ = incidence->inside;
  // cos falls with the angle.
  const auto cos_of = [](double degrees) { return std::cos(degrees * std::numbers::pi / 180); };
  band_max_cos_ = incidence->lower_deg <= 0 ? 2 : cos_of(incidence->lower_deg);
  band_min_cos_ = incidence->upper_deg >= 90 ? -1 : cos_of(incidence->upper_deg);
}

}  // namespace gonio::table
