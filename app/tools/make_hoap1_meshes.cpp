// Writes the meshes of robots/hoap1. Usage:
//   ayumi_make_meshes robots/hoap1/meshes
// Figures: robots/hoap1/README.md.

#include "link_mesh.hpp"

namespace ayumi::tools {

namespace {

LinkMesh torso() {
  LinkMesh mesh;
  mesh.box("grey", Axis::z, {-44, -64, 46}, {24, 64, 66}, 8);
  mesh.box("dark", Axis::z, {-42, -42, 64}, {20, 42, 92}, 8);
  mesh.loft("silver", Axis::z,
            {{86, -16, 0, 32, 46, 12},
             {93, -16, 0, 36, 53, 14},
             {150, -16, 0, 41, 61, 16},
             {184, -16, 0, 38, 59, 18},
             {196, -16, 0, 28, 46, 18}});
  mesh.loft("blue", Axis::x,
            {{21, 0, 138, 40, 30, 8}, {27, 0, 138, 38, 28, 8}, {29, 0, 138, 35, 25, 8}});
  mesh.box("blue", Axis::z, {-98, -48, 62}, {-56, 48, 180}, 10, 4);
  for (const double side : {1.0, -1.0}) mesh.motor("dark", Axis::y, {2, side * 64, 150}, 20, -7, 7);
  mesh.motor("dark", Axis::z, {-6, 0, 198}, 15, -5, 6);
  mesh.loft("silver", Axis::z,
            {{202, -6, 0, 24, 25, 16},
             {208, -6, 0, 32, 33, 20},
             {226, -6, 0, 33, 34, 21},
             {237, -6, 0, 27, 28, 20},
             {243, -6, 0, 16, 17, 14}});
  mesh.loft("visor", Axis::x,
            {{20, 0, 217, 27, 9, 7}, {28, 0, 217, 25, 8, 7}, {29.5, 0, 217, 23, 6.5, 6}});
  return mesh;
}

LinkMesh hip_yaw() {
  LinkMesh mesh;
  mesh.motor("dark", Axis::z, {0, 0, 30}, 19, -12, 12);
  mesh.motor("silver", Axis::z, {0, 0, 43}, 23, -3, 3, 1.5);
  mesh.box("silver", Axis::z, {-33, -15, 14}, {14, 15, 21}, 5, 2);
  mesh.box("silver", Axis::x, {-33, -15, -15}, {-27, 15, 21}, 5, 2);
  return mesh;
}

LinkMesh hip_roll() {
  LinkMesh mesh;
  mesh.motor("dark", Axis::x, {0, 0, 0}, 16, -26, 28);
  mesh.motor("blue", Axis::x, {0, 0, 0}, 18, 10, 24, 1.5);
  mesh.box("grey", Axis::y, {-14, -22, -15}, {16, 22, 12}, 5);
  return mesh;
}

LinkMesh thigh() {
  LinkMesh mesh;
  for (const double side : {1.0, -1.0})
    mesh.box("silver", Axis::z, {-14, side * 25.5 - 2.5, -40}, {15, side * 25.5 + 2.5, 14}, 2, 5);
  mesh.loft("silver", Axis::z,
            {{-94, 3, 0, 20, 20, 9},
             {-88, 4, 0, 25, 25, 10},
             {-46, 5, 0, 27, 25, 10},
             {-30, 4, 0, 24, 24, 10},
             {-24, 3, 0, 18, 20, 9}});
  mesh.motor("blue", Axis::y, {8, 0, -66}, 20, -28.5, 28.5);
  mesh.motor("dark", Axis::y, {0, 0, -100}, 13, -27, 27);
  return mesh;
}

LinkMesh shank() {
  LinkMesh mesh;
  mesh.motor("silver", Axis::y, {0, 0, 0}, 18, -21, 21);
  mesh.loft("silver", Axis::z,
            {{-84, 4, 0, 16, 19, 8},
             {-79, 5, 0, 21, 23, 9},
             {-34, 8, 0, 25, 24, 10},
             {-12, 4, 0, 19, 20, 9},
             {-6, 2, 0, 14, 17, 8}});
  mesh.loft("blue", Axis::x,
            {{24, 0, -46, 17, 22, 7}, {32, 0, -47, 14, 18, 7}, {34, 0, -47, 11, 15, 6}});
  mesh.motor("dark", Axis::y, {-6, 0, -62}, 15, -26, 26);
  return mesh;
}

LinkMesh ankle() {
  LinkMesh mesh;
  mesh.motor("dark", Axis::y, {0, 0, 0}, 14, -25, 25);
  mesh.motor("blue", Axis::y, {0, 0, 0}, 16, -10, 10, 1.5);
  mesh.box("grey", Axis::x, {-15, -15, -12}, {26, 15, 14}, 5);
  return mesh;
}

LinkMesh foot() {
  LinkMesh mesh;
  mesh.loft("dark", Axis::z,
            {{-37, 7, 0, 49, 31.5, 5}, {-33, 7, 0, 49, 31.5, 5}, {-31.5, 7, 0, 47.5, 30, 5}});
  mesh.loft("silver", Axis::z,
            {{-32, 7, 0, 47, 29.5, 8},
             {-25, 6, 0, 45, 28.5, 9},
             {-18, 1, 0, 36, 25, 9},
             {-16, 0, 0, 33, 22, 8}});
  mesh.loft("blue", Axis::z,
            {{-31, 44, 0, 11, 25, 8}, {-24, 42, 0, 9, 22, 8}, {-22, 41, 0, 7, 19, 6}});
  mesh.box("grey", Axis::z, {28, -13, -22}, {34, 13, 12}, 2, 2);
  mesh.box("grey", Axis::z, {-29, -13, -22}, {-23, 13, 12}, 2, 2);
  return mesh;
}

LinkMesh shoulder_pitch() {
  LinkMesh mesh;
  mesh.motor("silver", Axis::y, {0, 0, 0}, 20, -19, -4);
  // A fork that holds the roll motor at both ends. It is close to the axis for all directions of
  // the arm.
  mesh.box("blue", Axis::z, {-14, -18, -25}, {14, 14, -17}, 4);
  mesh.box("blue", Axis::z, {-14, -18, 16}, {14, 14, 24}, 4);
  return mesh;
}

LinkMesh shoulder_roll() {
  LinkMesh mesh;
  mesh.motor("dark", Axis::z, {0, 0, 0}, 14, -19, 17);
  mesh.motor("blue", Axis::z, {0, 0, 0}, 16, -12, 10, 1.5);
  mesh.box("silver", Axis::x, {4, -13, -14}, {40, 13, 13}, 6);
  return mesh;
}

LinkMesh upper_arm() {
  LinkMesh mesh;
  mesh.loft("silver", Axis::x,
            {{29, 0, 0, 13, 13, 8},
             {33, 0, 0, 16, 16, 9},
             {72, 0, 0, 17, 17, 9},
             {95, 0, 0, 15, 16, 9},
             {99, 0, 0, 12, 13, 8}});
  mesh.motor("blue", Axis::y, {80, 0, 0}, 16, -19, 19);
  for (const double side : {1.0, -1.0})
    mesh.box("grey", Axis::x, {86, side * 16.5 - 2, -10}, {126, side * 16.5 + 2, 10}, 2, 4);
  mesh.motor("dark", Axis::y, {115, 0, 0}, 10, -21, 21);
  return mesh;
}

LinkMesh forearm() {
  LinkMesh mesh;
  mesh.motor("silver", Axis::y, {0, 0, 0}, 14, -13.5, 13.5);
  mesh.loft(
      "silver", Axis::x,
      {{6, 0, 0, 11, 12, 7}, {11, 0, 0, 13, 14, 8}, {34, 0, 0, 15, 15, 9}, {45, 0, 0, 13, 13, 9}});
  mesh.motor("dark", Axis::x, {46, 0, 0}, 11, -3, 4, 1.5);
  mesh.loft("blue", Axis::x,
            {{48, 0, 0, 8, 10, 6},
             {53, 0, 0, 11, 14, 9},
             {64, 0, 0, 10, 13, 9},
             {70, 0, 0, 7, 9, 7},
             {72, 0, 0, 4, 5, 4}});
  return mesh;
}

const Materials kMaterials = {{"silver", {0.76, 0.78, 0.81}},
                              {"blue", {0.17, 0.27, 0.55}},
                              {"grey", {0.46, 0.48, 0.52}},
                              {"dark", {0.15, 0.16, 0.19}},
                              {"visor", {0.04, 0.05, 0.08}}};

}  // namespace

RobotMeshes hoap1() {
  return {.title = "HOAP-1",
          .source = "app/tools/make_hoap1_meshes.cpp",
          .name = "hoap1",
          .middle = {{"torso", torso()}},
          .sided = {{"hip_yaw_link", hip_yaw()},
                    {"hip_roll_link", hip_roll()},
                    {"thigh", thigh()},
                    {"shank", shank()},
                    {"ankle_link", ankle()},
                    {"foot", foot()},
                    {"shoulder_pitch_link", shoulder_pitch()},
                    {"shoulder_roll_link", shoulder_roll()},
                    {"upper_arm", upper_arm()},
                    {"forearm", forearm()}},
          .materials = kMaterials};
}

}  // namespace ayumi::tools

int main(int argc, char** argv) {
  return ayumi::tools::write_meshes(argc, argv, ayumi::tools::hoap1());
}
