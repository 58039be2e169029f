// SPDX-License-Identifier: BSD-3-Clause
// Cameras of photographs a.jpg and b.jpg, behind the extension of their file: what a program of photogrammetry writes.
#include "generator_scans.h"
#include "targets.h"
#include <fresco/core/require.h>
namespace fresco::fuzz {
namespace {
const char* const photographs[] = {"a.jpg", "b.jpg"};

/// Half a turn around an axis, none around the fourth.
int halfTurn(int axis, int row, int column) { return row != column ? 0 : axis == 3 || axis == row ? 1 : -1; }

/// A half turn by rows.
std::string rotation(Dice& dice, const char* between)
{
  const int axis = dice.below(4);
  std::string text;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      text += concat(r + c > 0 ? between : "", halfTurn(axis, r, c));
  return text;
}

std::string place(Dice& dice, const char* between)
{
  return concat(dice.value(), between, dice.value(), between, dice.value());
}

/// World from camera by rows. @param begin, end what is around a row @param between what is between numbers
std::string matrix(Dice& dice, const char* begin, const char* end, const char* between)
{
  const int axis = dice.below(4);
  std::string text;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c)
      text += concat(r + c > 0 ? between : "", c == 0 ? begin : "",
                     r < 3 && c == 3 ? dice.value()
                     : r == 3        ? float(c == 3)
                                     : float(halfTurn(axis, r, c)),
                     c == 3 ? end : "");
  return text;
}

Parts metashape(Dice& dice)
{
  const std::string type = dice.of<std::string>({"frame", "fisheye"});
  Parts parts{"<?xml version=\"1.0\"?>\n<document version=\"2.0.0\">\n<chunk label=\"c\">\n<sensors>\n",
              "<sensor id=\"0\" type=\"" + type + "\">\n<resolution width=\"64\" height=\"48\"/>\n",
              "<calibration type=\"" + type + "\" class=\"adjusted\">\n",
              "<f>60</f>\n",
              "<cx>1.5</cx>\n",
              "<k1>-0.1</k1>\n",
              "<b1>.5</b1>\n",
              "</calibration></sensor></sensors>\n<cameras>\n"};
  for (const char* name : photographs)
    parts.push_back(concat("<camera id=\"", name, "\" sensor_id=\"0\" label=\"", name, "\"><transform>",
                           matrix(dice, "", "", " "), "</transform></camera>\n"));
  parts.push_back("</cameras>\n");
  if (dice.chance())
    parts.push_back("<transform><rotation>" + rotation(dice, " ") + "</rotation><translation>" + place(dice, " ") +
                    "</translation><scale>2.5</scale></transform>\n");
  parts.push_back("</chunk></document>\n");
  return parts;
}

Parts bundler(Dice& dice)
{
  const int points = dice.below(4);
  Parts parts{"# Bundle file v0.3\n", concat("2 ", points, "\n")};
  for (int view = 0; view < 2; ++view)
    parts.insert(parts.end(), {"60 -0.1 0.01\n", rotation(dice, " ") + "\n", place(dice, " ") + "\n"});
  for (int p = 0; p < points; ++p)
    parts.insert(parts.end(), {place(dice, " ") + "\n", "10 20 30\n", "2 0 5 1.5 -2 1 6 -3 4\n"});
  return parts;
}

Parts nvm(Dice& dice)
{
  const int points = dice.below(4);
  Parts parts{dice.chance() ? "NVM_V3\n\n" : "NVM_V3 FixedK 60 32 60 24 0.1\n\n", "2\n"};
  for (const char* name : photographs)
    parts.push_back(concat(name, "\t60 ", dice.of<std::string>({"1 0 0 0", "0 0 1 0", ".5 .5 -.5 .5"}), " ",
                           place(dice, " "), " 0.1 0\n"));
  parts.push_back(concat("\n", points, "\n"));
  for (int p = 0; p < points; ++p)
    parts.push_back(place(dice, " ") + " 10 20 30 2 0 5 1.5 -2 1 6 -3 4\n");
  parts.push_back("\n0\n");
  return parts;
}

Parts transforms(Dice& dice)
{
  Parts parts{"{\n", dice.chance() ? "\"camera_angle_x\": 0.9,\n" : "\"fl_x\": 60, \"fl_y\": 61,\n"};
  if (dice.chance())
    parts.insert(parts.end(), {"\"w\": 64, \"h\": 48,\n", "\"cx\": 31.5, \"cy\": 24,\n"});
  if (dice.chance())
    parts.insert(parts.end(), {"\"camera_model\": \"OPENCV\",\n", "\"k1\": -0.1, \"k4\": 0.01,\n"});
  parts.push_back("\"frames\": [\n");
  for (const char* name : photographs)
    parts.insert(parts.end(), {concat("{\"file_path\": \"./images/", name, "\",\n"),
                               "\"transform_matrix\": [" + matrix(dice, "[", "]", ", ") + "]}\n",
                               name == photographs[0] ? ",\n" : "]}\n"});
  return parts;
}

Parts openMvg(Dice& dice)
{
  const bool radial = dice.chance();
  Parts parts{"{\"sfm_data_version\": \"0.3\", \"root_path\": \"/data\",\n\"views\": [\n"};
  const auto between = [](int view) { return view == 0 ? ",\n" : "],\n"; };
  for (int view = 0; view < 2; ++view)
    parts.push_back(concat("{\"key\": ", view, ", \"value\": {\"ptr_wrapper\": {\"data\": {\"local_path\": \"\", ",
                           "\"filename\": \"", photographs[view], "\", \"width\": 64, \"height\": 48, \"id_view\": ",
                           view, ", \"id_intrinsic\": 0, \"id_pose\": ", view, "}}}}", between(view)));
  parts.push_back(concat("\"intrinsics\": [{\"key\": 0, \"value\": {\"ptr_wrapper\": {\"data\": {\n",
                         "\"value0\": {\"width\": 64, \"height\": 48, \"focal_length\": 60, ",
                         "\"principal_point\": [32, 24]}\n", radial ? ", \"disto_k3\": [-0.1, 0.01, 0]" : "",
                         "}}}}],\n\"extrinsics\": [\n"));
  for (int view = 0; view < 2; ++view)
    parts.push_back(concat("{\"key\": ", view, ", \"value\": {\"rotation\": [[",
                           "1, 0, 0], [0, 1, 0], [0, 0, 1]], \"center\": [", place(dice, ", "), "]}}", between(view)));
  parts.insert(parts.end(), {"\"structure\": [{\"key\": 5, \"value\": {\"X\": [" + place(dice, ", ") + "],\n",
                             "\"observations\": [{\"key\": 0, \"value\": {\"id_feat\": 1, \"x\": [3.5, 4]}}]}}]}\n"});
  return parts;
}
} // namespace

GeneratedFile cameras(Dice& dice)
{
  struct Program {
    const char* extension;
    Parts (*write)(Dice&);
  };
  const Program program = dice.of<Program>(
      {{".xml", metashape}, {".out", bundler}, {".nvm", nvm}, {".json", transforms}, {".json", openMvg}});
  Parts parts{program.extension, std::string(separator)};
  for (std::string& part : program.write(dice))
    parts.push_back(std::move(part));
  return {parts};
}
} // namespace fresco::fuzz
