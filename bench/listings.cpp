// listings: what the published shader listings (brdf/listings.h) cost on this CPU, beside their
// rivals, and what becomes of their authors' claims.
//
// Exit status: 0 measured; 2 wrong usage; 3 out of memory. A time is never a failure.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <numbers>
#include <numeric>
#include <random>
#include <span>
#include <string_view>
#include <vector>

#include "bench/listing_kernels.h"
#include "bench/study_main.h"

namespace gonio::bench {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

class RandomVectors {
 public:
  Vector on_sphere() {
    const double z = std::uniform_real_distribution<double>(-1, 1)(generator_);
    const double phi = std::uniform_real_distribution<double>(0, 2 * std::numbers::pi)(generator_);
    const double sine = std::sqrt(1 - z * z);
    return {sine * std::cos(phi), sine * std::sin(phi), z};
  }

  /// A vector that `accepts` takes.
  template <class Accepts>
  Vector on_sphere_where(const Accepts& accepts) {
    Vector w = on_sphere();
    while (!accepts(w)) w = on_sphere();
    return w;
  }

 private:
  std::mt19937_64 generator_{1975};
};

void append(Vectors& vectors, const Vector& v) {
  vectors.x.push_back(static_cast<float>(v[0]));
  vectors.y.push_back(static_cast<float>(v[1]));
  vectors.z.push_back(static_cast<float>(v[2]));
}

/// Random pixels that are as coherent as those of an image, so that branches can be predicted: in
/// the first half the viewer is on the light's side, in the second on the other, and everywhere
/// within a quarter turn of the mirror direction, beyond which a shader's power is that of 0.
Pixels random_pixels(std::size_t count) {
  constexpr double margin = 0.05;  // so that no cosine rounds to below 0
  Pixels pixels;
  RandomVectors random;
  for (std::size_t i = 0; i < count; ++i) {
    const bool same_side = i < count / 2;
    const Vector n = random.on_sphere();
    const Vector l = random.on_sphere_where([&](const Vector& w) { return dot(n, w) > margin; });
    const Vector v = random.on_sphere_where([&](const Vector& w) {
      const double cosines = dot(n, l) * dot(n, w);
      const double horizontal = dot(l, w) - cosines;  // sin sin cos(dphi)
      const double mirror = cosines - horizontal;
      return dot(n, w) > margin && mirror > margin && (horizontal > 0) == same_side;
    });
    append(pixels.n, n);
    append(pixels.l, l);
    append(pixels.v, v);
  }
  return pixels;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The times of one kernel, in ns per pixel, one per round.
struct Measured {
  Kernel kernel;
  std::vector<double> times;
  double checksum = 0;
};

void run_once(Measured& measured, const Pixels& pixels, std::span<float> values) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  measured.kernel.evaluate(pixels, values);
  const std::chrono::duration<double, std::nano> elapsed = Clock::now() - start;
  measured.times.push_back(elapsed.count() / static_cast<double>(pixels.size()));
  measured.checksum = std::accumulate(values.begin(), values.end(), 0.0);
}

/// A group's kernels, compiled in both ways.
struct Study {
  std::string_view name;
  std::vector<Measured> scalar, vectorised;
};

std::vector<Measured> not_yet_measured(std::span<const Kernel> kernels) {
  std::vector<Measured> all;
  for (const Kernel& kernel : kernels) all.push_back({.kernel = kernel, .times = {}});
  return all;
}

/// Every kernel once per round, so that what else the machine does hits all alike. A first round is
/// run for the caches and forgotten.
std::vector<Study> measure(const Pixels& pixels, int rounds) {
  std::vector<Study> studies;
  for (std::size_t g = 0; g < scalar_kernels().size(); ++g) {
    studies.push_back({scalar_kernels()[g].name, not_yet_measured(scalar_kernels()[g].kernels),
                       not_yet_measured(vectorised_kernels()[g].kernels)});
  }
  std::vector<float> values(pixels.size());
  for (int round = -1; round < rounds; ++round) {
    for (Study& study : studies) {
      for (auto* way : {&study.scalar, &study.vectorised}) {
        for (Measured& measured : *way) {
          run_once(measured, pixels, values);
          if (round < 0) measured.times.clear();
        }
      }
    }
  }
  return studies;
}

/// How many times as long as the first of them: the median over the rounds of the ratio within one.
double ratio_to_first(std::span<const Measured> way, std::size_t k) {
  std::vector<double> ratios;
  for (std::size_t round = 0; round < way[k].times.size(); ++round) {
    ratios.push_back(way[k].times[round] / way[0].times[round]);
  }
  return median(std::move(ratios));
}

void print_table(const std::vector<Study>& studies) {
  fmt::print("{:<30}{:>12}{:>8}{:>16}{:>8}{:>14}\n", "ns per pixel, median", "scalar", "ratio",
             "as vectorised", "ratio", "checksum");
  for (const Study& study : studies) {
    fmt::print("{}\n", study.name);
    for (std::size_t k = 0; k < study.scalar.size(); ++k) {
      const Measured& scalar = study.scalar[k];
      const Measured& vectorised = study.vectorised[k];
      fmt::print("  {:<28}{:>12.2f}{:>8.2f}{:>16.2f}{:>8.2f}{:>14.4f}\n", scalar.kernel.name,
                 median(scalar.times), ratio_to_first(study.scalar, k), median(vectorised.times),
                 ratio_to_first(study.vectorised, k), scalar.checksum + vectorised.checksum);
    }
  }
}

/// 2 % apart is within what two runs differ by.
constexpr double tellable = 0.02;

std::string_view verdict_on_much_faster(double speed) {
  if (speed >= 2) return "the claim holds";
  return speed > 1 + tellable ? "faster, but not by much" : "the claim does not hold";
}

std::string_view verdict_on_cheaper(double ratio) {
  if (ratio < 1 - tellable) return "the claim holds";
  return ratio <= 1 + tellable ? "no difference that can be told" : "the claim does not hold";
}

void print_way(std::string_view name, const Study& oren_nayar, const Study& phong,
               const Study& ward, std::vector<Measured> Study::*way) {
  const double rewrite = 1 / ratio_to_first(oren_nayar.*way, 1);
  const double product = 1 / ratio_to_first(oren_nayar.*way, 2);
  const double blinn = ratio_to_first(phong.*way, 1);
  const double lit = ratio_to_first(phong.*way, 2);
  fmt::print("\n{}:\n", name);
  fmt::print(
      "  Oren-Nayar: van Ouwerkerk's rewrite is {:.1f} times as fast as sin and tan: {}.\n"
      "    Without normalise and root it is {:.1f} times as fast as sin and tan, {:.1f} times as\n"
      "    fast as the rewrite.\n",
      rewrite, verdict_on_much_faster(rewrite), product, product / rewrite);
  fmt::print(
      "  Blinn-Phong by lit() takes {:.2f} of Phong's time, said to be slightly cheaper: {}.\n"
      "    Blinn-Phong without lit() takes {:.2f}: that much is the half vector's doing.\n",
      lit, verdict_on_cheaper(lit), blinn);
  fmt::print(
      "  Ward: the table takes {:.2f} of the time of tan(acos(n.h)), the arithmetic 1/(n.h)^2 - 1\n"
      "    {:.2f}, the components of l + v {:.2f}.\n",
      ratio_to_first(ward.*way, 1), ratio_to_first(ward.*way, 2), ratio_to_first(ward.*way, 3));
}

void print_words(const std::vector<Study>& studies) {
  fmt::print(
      "\nA ratio is the time over that of the group's first line, in the same round. On this CPU,\n"
      "as compiled: a GPU, which has exp2, log2, sin and a square root as instructions, may "
      "differ.\n");
  print_way("Scalar", studies[0], studies[1], studies[2], &Study::scalar);
  print_way("As the compiler vectorises it", studies[0], studies[1], studies[2],
            &Study::vectorised);
}

int run(int argc, char** argv) {
  int rounds = 1001;
  bool is_short = false;
  CLI::App app{"What the published shader listings cost on this CPU, beside their rivals."};
  app.name("listings");
  app.add_option("--rounds", rounds, "Measurements of each kernel")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app.add_flag("--short", is_short, "5 rounds over few pixels, to see that it runs");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "listings: {} (--help says what there is)\n", error.what());
    return 2;
  }
  const std::vector<Study> studies =
      is_short ? measure(random_pixels(256), 5) : measure(random_pixels(4096), rounds);
  print_table(studies);
  print_words(studies);
  return 0;
}

}  // namespace
}  // namespace gonio::bench

int main(int argc, char** argv) {
  return gonio::bench::study_main("listings", gonio::bench::run, argc, argv);
}
