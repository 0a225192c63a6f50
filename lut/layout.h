// Which look-up tables there are, and what their axes mean.
//
//   ward-exponent      -tan^2 of the angle between normal and half vector: the exponent of Ward's
//                      lobes times alpha^2 (1D), for ward, ward-duer, ward-gmd, also -aniso
//   ward-lobe          exp of that over alpha^2, the whole numerator: over (coordinate, alpha), or
//                      for one alpha (height 1); for the same models
//   blinn-phong-power  (n.h)^exponent over (coordinate, exponent), or for one exponent
//   strauss-j          j = F(x_i) G(x_i) G(x_o) in channel 0 and 1 - F(x_i) in channel 1, over the
//                      coordinates of (n.wi, n.wo); for strauss and strauss-listing
//   strauss-terms      for a fixed t: (1 - m s)(1 - s^3)(1 - t) in channel 0 and s^3 (1 - t) in
//                      channel 1, over (s, m)
//
// The first axis of the first three, and both of strauss-j, run over a coordinate c(w) in 0..1 of a
// number w that is 0 where the table is steepest: w = 1 - n.h for the lobes; for strauss-j the
// cosine of the polar angle, with which its angle's complement goes to 0, and 1 minus the cosine
// for strauss-listing.
//
//   cosine       w / reach
//   sqrt         sqrt(w / reach)
//   fourth-root  sqrt(sqrt(w / reach))
//   listing      n.h itself, from -1 to 1, in the published way (ward-exponent only): texel x of N
//                holds -(tan(acos(2 x/N - 1)))^2 in float and is read at u = (n.h + 1)/2
//
// The first and the last texel are centred on c = 0 and 1: u = (c (N - 1) + 1/2) / N; in `listing`
// nothing is. Beyond `reach` c is above 1: the addressing clamps to the last texel, which says that
// the lobe is 0 (table.h), and no rounding of u mixes the texel before it in.
// The axes of strauss-terms are s and m themselves, w = s and w = m of `cosine`.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "brdf/bound_model.h"
#include "lut/texture.h"

namespace gonio::lut {

enum class TableKind { ward_exponent, ward_lobe, blinn_phong_power, strauss_j, strauss_terms };
enum class Coordinate { listing, cosine, sqrt, fourth_root };

inline constexpr std::array all_table_kinds{TableKind::ward_exponent, TableKind::ward_lobe,
                                            TableKind::blinn_phong_power, TableKind::strauss_j,
                                            TableKind::strauss_terms};
inline constexpr std::array all_coordinates{Coordinate::listing, Coordinate::cosine,
                                            Coordinate::sqrt, Coordinate::fourth_root};

/// Whether it is strauss-j or strauss-terms, whose two axes and two channels are of strauss.
bool is_strauss(TableKind kind);

/// 2 for the strauss tables, else 1.
int channels_of(TableKind kind);

/// "alpha" or "exponent": what the rows of a lobe's table are of. Not for the strauss tables.
std::string_view parameter_of(TableKind kind);

/// "ward-exponent", ..
std::string_view name_of(TableKind kind);
/// "listing", "cosine", "sqrt", "fourth-root"
std::string_view name_of(Coordinate coordinate);
/// These throw std::invalid_argument with the names that there are.
TableKind table_kind_named(std::string_view name);
Coordinate coordinate_named(std::string_view name);
Storage storage_named(std::string_view name);
Filter filter_named(std::string_view name);

inline constexpr int least_size = 16;
inline constexpr int largest_size = 4096;

/// A table but for its texels.
struct Layout {
  TableKind kind = TableKind::ward_exponent;
  Coordinate coordinate = Coordinate::cosine;
  /// The w at which the first axis ends, above 0 and at most 1.
  double reach = 1;
  int width = 512;  // least_size to largest_size
  int height = 1;   // 1 or as width; 1 for ward-exponent, at least least_size for strauss tables
  Storage storage = Storage::r32f;
  /// The parameters that the table serves. ward tables: alpha; blinn-phong-power: exponent. The
  /// rows of ward-lobe and blinn-phong-power are evenly spaced in the logarithm, the first centred
  /// on `lowest` and the last on `highest`; with height 1 both are the one value.
  double lowest = 1;
  double highest = 1;
  /// strauss-j: x is the cosine, as in strauss-listing, and not the angle over pi/2.
  bool of_cosine = false;
  /// strauss-terms: t.
  double transparency = 0;
};

/// Throws std::invalid_argument that says what is wrong with the layout and what is possible.
void check(const Layout& layout);

/// Whether the second axis is of a lobe's parameter: each row another alpha or exponent.
bool has_rows(const Layout& layout);

/// exp(-x) is taken for 0 from here on: 1.1e-7, one step of a float at 1.
inline constexpr double negligible_decay = 16;

/// r16f holds ward-exponent for alphas up to so many times smaller than the largest: there half the
/// step of its smallest numbers is 1e-4 of the exponent at the most, no more than the rounding of
/// its others makes of the lobe.
inline constexpr double most_alphas_of_half = 2000;

/// Whether the table is ward-exponent for any alpha, whatever `lowest` and `highest` are: to the
/// horizon, and of floats that need no scale.
bool serves_any_alpha(const Layout& layout);

/// The reach that the lobes of the parameters served need: where the widest is exp(-16) of its
/// peak. 1 for the strauss tables.
double lobe_reach(const Layout& layout);

/// u of w for the first axis (and v of the strauss tables): texture coordinate as sample() takes
/// it, of an axis of `size` texels.
template <class T>
T texture_coordinate(const Layout& layout, int size, T w);

/// The w whose coordinate is c in 0..1: the inverse of c(w), which for `listing` is (n.h + 1)/2.
double distance_at(const Layout& layout, double c);

/// The texture coordinate of the row of that alpha or exponent, clamped to the first and last.
template <class T>
T row_coordinate(const Layout& layout, T parameter);

/// Whether the term can be evaluated by tables of the kind.
bool is_served(const brdf::TermDescription& term, TableKind kind);

/// The tables by which terms of the model can be evaluated; empty if there are none.
std::vector<TableKind> tables_for(const brdf::Model& model);

/// How many rows rows_for() gives a range of parameters.
inline constexpr int rows_of_a_range = 64;

/// The height that the parameters of the layout need: 1, rows_of_a_range, or `width` for strauss
/// tables.
int rows_for(const Layout& layout);

/// A layout of the kind that serves the model's parameters: lowest and highest (for an anisotropic
/// lobe its alphas; for two lobes those of both), of_cosine, transparency, and the height that
/// these need (rows_for). Throws std::invalid_argument that
/// names the model's tables if this is none of them.
Layout layout_for(const brdf::BoundModel& model, TableKind kind);

}  // namespace gonio::lut
