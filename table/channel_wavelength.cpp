#include "table/channel_wavelength.h"

#include <charconv>
#include <string>
#include <system_error>

namespace gonio::table {

bool is_rgb_channel(std::string_view channel) {
  return channel.size() == 1 &&
         std::string_view("RGBrgb").find(channel.front()) != std::string_view::npos;
}

std::optional<double> wavelength_of_channel(std::string_view channel) {
  constexpr double metres_per_nm = 1e-9;
  if (is_rgb_channel(channel)) {
    const char letter = channel.front();
    const bool is_red = letter == 'R' || letter == 'r';
    const bool is_green = letter == 'G' || letter == 'g';
    return (is_red ? 611.4 : is_green ? 549.1 : 464.3) * metres_per_nm;
  }
  double value = 0;
  const char* const end = channel.data() + channel.size();
  const auto [rest, error] = std::from_chars(channel.data(), end, value);
  if (error != std::errc() || !(value > 0)) return std::nullopt;
  const std::string_view unit(rest, static_cast<std::size_t>(end - rest));
  if (unit != "nm" && unit != " nm") return std::nullopt;
  return value * metres_per_nm;
}

}  // namespace gonio::table
