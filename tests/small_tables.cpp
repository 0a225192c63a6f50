#include "tests/small_tables.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <iterator>

#include "brdf/direction.h"
#include "table/formats/exr_table_writer.h"
#include "table/formats/openmaterial_writer.h"
#include "table/sample_table.h"
#include "tests/tensor_bytes.h"

namespace gonio::tests {
namespace {

template <class T>
void append(std::string& bytes, const T& value) {
  const char* at = reinterpret_cast<const char*>(&value);
  bytes.append(at, sizeof value);
}

/// Six samples of one incidence, with a hole, sigma and weights.
table::SampleTable six_samples() {
  table::SampleTable table;
  table.name = "six";
  table.channels = {"465nm", "630nm"};
  table.values.resize(2);
  table.sigma.resize(2);
  for (int i = 0; i < 6; ++i) {
    table.wi.push_back(brdf::direction_from_degrees(20, 180));
    table.wo.push_back(brdf::direction_from_degrees(10.0 * i, 30.0 * i));
    for (std::size_t c = 0; c < 2; ++c) {
      table.values[c].push_back(0.1 * (i + 1) / (static_cast<double>(c) + 1));
      table.sigma[c].push_back(0.01);
    }
    table.weight.push_back(0.5 + i);
    table.mask.push_back(i == 3 ? table::MaskReason::retro : table::MaskReason::none);
  }
  return table;
}

std::string gonio_csv() {
  return "# gonio-table 1\n# quantity: brdf\n# angles: deg\n# name: small\n"
         "theta_i,phi_i,theta_o,phi_o,R,G,sigma_R,sigma_G,weight\n"
         "20,180,20,0,1.25,1.13,0.025,0.023,1\n"
         "20,180,25,0,0.87,,0.017,,1\n"
         "90,180,25.5,-1e1,0.87,0.5,0.017,1e-3,0\n";
}

std::string foreign_csv() {
  return "measured by hand\ntheta_i_deg;phi_i_deg;theta_o_deg;phi_o_deg;R;G\n"
         "20;180;20;0;1.25;0.75\n20;180;30;0;0.5;\n40;180;30;0;0.25;0.125\n";
}

std::string astm() {
  std::string text =
      "SAMPLE_NAME small\nMEAS_NAME BRDF\nVARS theta_i,phi_i,theta_s,465nm,630nm\n\n";
  for (int i = 0; i < 8; ++i) {
    text += fmt::format("0.349,3.14159,{},0,{},{}\n", 0.1 * i, 1.5 + 0.1 * i, 0.75);
  }
  return text;
}

std::string merl() {
  std::string bytes;
  for (const std::int32_t count : {3, 3, 4}) append(bytes, count);
  for (int i = 0; i < 3 * 36; ++i) append(bytes, i % 7 == 0 ? -1.0 : 150.0 + i);
  return bytes;
}

std::vector<float> constant(std::size_t count, float value) {
  std::vector<float> values(count, value);
  return values;
}

std::string rgl() {
  return tensor_file_of({{"phi_i", {1}, {0.0F}},
                         {"theta_i", {3}, {0.0F, 0.5F, 1.2F}},
                         {"ndf", {2, 3}, {0.1F, 0.2F, 0.4F, 0.1F, 0.2F, 0.4F}},
                         {"sigma", {2, 2}, constant(4, 0.5F)},
                         {"vndf", {1, 3, 3, 4}, constant(36, 1.0F)},
                         {"luminance", {1, 3, 3, 3}, constant(27, 0.3F)},
                         {"rgb", {1, 3, 3, 3, 3}, constant(81, 0.3F)}});
}

std::string rgl_spectral() {
  return tensor_file_of({{"phi_i", {1}, {0.0F}},
                         {"theta_i", {2}, {0.0F, 1.2F}},
                         {"ndf", {2, 2}, constant(4, 0.2F)},
                         {"sigma", {2, 2}, constant(4, 0.5F)},
                         {"vndf", {1, 2, 2, 2}, constant(8, 1.0F)},
                         {"luminance", {1, 2, 2, 2}, constant(8, 0.3F)},
                         {"wavelengths", {3}, {450.0F, 550.0F, 650.0F}},
                         {"spectra", {1, 2, 3, 2, 2}, constant(24, 0.3F)}});
}

std::string zemax(bool tristimulus) {
  std::string text = "# small\nSource\tMeasured\nSymmetry\tPlaneSymmetrical\n";
  text +=
      fmt::format("SpectralContent\t{}\nScatterType\tBRDF\n", tristimulus ? "XYZ" : "Monochrome");
  text +=
      "SampleRotation\t1\n0\nAngleOfIncidence\t2\n10\t50\nScatterAzimuth\t3\n0\t90\t180\n"
      "ScatterRadial\t4\n0\t20\t60\t120\n\n";
  const std::vector<std::string> blocks =
      tristimulus ? std::vector<std::string>{"TristimulusX", "TristimulusY", "TristimulusZ"}
                  : std::vector<std::string>{"Monochrome"};
  for (const std::string& block : blocks) {
    text += block + "\nDataBegin\n";
    for (int incidence = 0; incidence < 2; ++incidence) {
      text += "TIS\t0.05\n";
      for (int azimuth = 0; azimuth < 3; ++azimuth) text += "5e-2\t4e-2\t1e-2\t0\n";
    }
    text += "DataEnd\n";
  }
  return text;
}

/// A pole and a ring of four patches; the value is 10 times the exit patch plus the incident one.
std::string klems() {
  const auto ring = [](double theta, double lower, double upper, int count) {
    return fmt::format(
        "<AngleBasisBlock><Theta>{}</Theta><ThetaBounds><LowerTheta>{}</LowerTheta>"
        "<UpperTheta>{}</UpperTheta></ThetaBounds><nPhis>{}</nPhis></AngleBasisBlock>\n",
        theta, lower, upper, count);
  };
  std::string text =
      "<?xml version=\"1.0\"?>\n<WindowElement><Optical><Layer><Material><Name>small</Name>"
      "</Material>\n<DataDefinition><IncidentDataStructure>Columns</IncidentDataStructure>\n"
      "<AngleBasis><AngleBasisName>small</AngleBasisName>\n" +
      ring(0, 0, 30, 1) + ring(60, 30, 90, 4) +
      "</AngleBasis></DataDefinition>\n<WavelengthData><Wavelength>Visible</Wavelength>"
      "<WavelengthDataBlock>\n<WavelengthDataDirection>Reflection Front"
      "</WavelengthDataDirection>\n<ColumnAngleBasis>small</ColumnAngleBasis>"
      "<RowAngleBasis>small</RowAngleBasis>\n<ScatteringData>";
  for (int exit = 0; exit < 5; ++exit) {
    for (int incident = 0; incident < 5; ++incident) {
      text += fmt::format("{} {}", exit + incident == 0 ? "" : ",", 10 * exit + incident);
    }
    text += '\n';
  }
  return text +
         "</ScatteringData></WavelengthDataBlock></WavelengthData></Layer></Optical>"
         "</WindowElement>\n";
}

std::string exr() {
  std::string bytes;
  table::write_exr_table(six_samples(), {}, [&](std::string_view piece) { bytes += piece; });
  return bytes;
}

std::string openmaterial() {
  std::string text;
  table::write_openmaterial(six_samples(), {}, [&](std::string_view piece) { text += piece; });
  return text;
}

std::string curet_measurements() {
  std::string text;
  for (int material = 1; material <= 2; ++material) {
    text += fmt::format("{}", material);
    for (int i = 0; i < 60; ++i) text += fmt::format(" {:.3f}", i == 5 ? 0.0 : 0.1 + 0.01 * i);
    text += '\n';
  }
  return text;
}

std::string curet_directions() {
  std::string text;
  for (int i = 0; i < 60; ++i) {
    text += fmt::format("{} {} -1.0 0.25 3.0\n", i + 1, 0.02 * i);
  }
  return text;
}

}  // namespace

std::vector<SmallTable> small_tables() {
  return {{"gonio_csv", "small.csv", gonio_csv()},
          {"foreign_csv", "foreign.csv", foreign_csv()},
          {"astm", "small.astm", astm()},
          {"merl", "small.binary", merl()},
          {"rgl", "small.bsdf", rgl()},
          {"rgl", "spectral.bsdf", rgl_spectral()},
          {"zemax", "mono.bsdf", zemax(false)},
          {"zemax", "xyz.bsdf", zemax(true)},
          {"klems", "small.xml", klems()},
          {"exr", "small.exr", exr()},
          {"openmaterial", "small.xompt", openmaterial()},
          {"curet", "abrdf.dat", curet_measurements()},
          {"curet", "table.txt", curet_directions()}};
}

}  // namespace gonio::tests
