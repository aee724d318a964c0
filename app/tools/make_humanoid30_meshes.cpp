// Writes the meshes of robots/humanoid30. Usage:
//   ayumi_make_humanoid30_meshes robots/humanoid30/meshes
// Figures: robots/humanoid30/README.md.

#include "link_mesh.hpp"

namespace ayumi::tools {

namespace {

LinkMesh torso() {
  LinkMesh mesh;
  // The pelvis with the batteries, a narrow waist, the chest, a pack and a collar.
  mesh.loft("white", Axis::z,
            {{46, 0, 0, 62, 88, 22},
             {62, 0, 0, 76, 106, 28},
             {128, 0, 0, 78, 108, 30},
             {148, 0, 0, 68, 94, 26}});
  mesh.motor("dark", Axis::z, {0, 0, 158}, 66, -16, 16, 4);
  mesh.loft("white", Axis::z,
            {{168, -4, 0, 66, 98, 30},
             {192, -4, 0, 80, 118, 34},
             {300, -5, 0, 88, 132, 40},
             {392, -6, 0, 84, 134, 46},
             {420, -6, 0, 62, 100, 42},
             {432, -4, 0, 44, 62, 30}});
  mesh.loft("orange", Axis::x,
            {{76, 0, 318, 74, 56, 20}, {86, 0, 318, 70, 52, 20}, {91, 0, 318, 60, 42, 18}});
  mesh.box("grey", Axis::z, {-176, -100, 150}, {-92, 100, 390}, 24, 10);
  for (const double side : {1.0, -1.0})
    mesh.motor("dark", Axis::y, {0, side * 132, 400}, 44, -14, 14, 4);
  mesh.motor("dark", Axis::z, {0, 0, 434}, 30, -8, 8);
  return mesh;
}

LinkMesh hip_yaw() {
  LinkMesh mesh;
  mesh.motor("dark", Axis::z, {0, 0, 48}, 42, -18, 8, 4);
  mesh.box("grey", Axis::z, {-74, -34, 26}, {34, 34, 36}, 10, 3);
  mesh.box("grey", Axis::x, {-74, -34, -34}, {-62, 34, 36}, 10, 3);
  return mesh;
}

LinkMesh hip_roll() {
  LinkMesh mesh;
  mesh.motor("dark", Axis::x, {0, 0, 0}, 34, -60, 60, 4);
  mesh.motor("orange", Axis::x, {0, 0, 0}, 38, 30, 52, 3);
  mesh.box("grey", Axis::y, {-30, -46, -32}, {34, 46, 26}, 10);
  return mesh;
}

LinkMesh thigh() {
  LinkMesh mesh;
  for (const double side : {1.0, -1.0})
    mesh.box("grey", Axis::z, {-32, side * 53 - 5, -90}, {34, side * 53 + 5, 32}, 6, 12);
  mesh.loft("white", Axis::z,
            {{-238, 6, 0, 44, 42, 20},
             {-222, 8, 0, 52, 50, 22},
             {-130, 11, 0, 58, 53, 24},
             {-72, 9, 0, 52, 50, 22},
             {-56, 7, 0, 40, 42, 20}});
  mesh.motor("orange", Axis::y, {16, 0, -150}, 34, -57, 57, 4);
  mesh.motor("dark", Axis::y, {0, 0, -260}, 30, -54, 54, 4);
  return mesh;
}

LinkMesh shank() {
  LinkMesh mesh;
  mesh.motor("white", Axis::y, {0, 0, 0}, 42, -44, 44, 5);
  mesh.loft("white", Axis::z,
            {{-222, 8, 0, 34, 36, 18},
             {-208, 10, 0, 42, 43, 20},
             {-110, 14, 0, 51, 47, 22},
             {-40, 8, 0, 42, 42, 20},
             {-22, 4, 0, 32, 36, 18}});
  mesh.loft("orange", Axis::x,
            {{52, 0, -112, 36, 62, 16}, {66, 0, -114, 31, 54, 16}, {71, 0, -114, 25, 46, 14}});
  mesh.motor("dark", Axis::y, {-10, 0, -170}, 30, -52, 52, 4);
  return mesh;
}

LinkMesh ankle() {
  LinkMesh mesh;
  mesh.motor("dark", Axis::y, {0, 0, 0}, 30, -48, 48, 4);
  mesh.motor("orange", Axis::y, {0, 0, 0}, 34, -20, 20, 3);
  mesh.box("grey", Axis::x, {-34, -30, -24}, {52, 30, 28}, 10);
  return mesh;
}

LinkMesh foot() {
  LinkMesh mesh;
  mesh.loft("dark", Axis::z,
            {{-80, 20, 0, 120, 70, 14}, {-72, 20, 0, 120, 70, 14}, {-68, 20, 0, 116, 66, 14}});
  mesh.loft("white", Axis::z,
            {{-69, 20, 0, 115, 65, 22},
             {-56, 17, 0, 110, 62, 24},
             {-42, 2, 0, 84, 54, 24},
             {-36, 0, 0, 72, 46, 22}});
  mesh.loft("orange", Axis::z,
            {{-66, 112, 0, 24, 54, 18}, {-54, 106, 0, 20, 48, 18}, {-48, 103, 0, 15, 42, 15}});
  mesh.box("grey", Axis::z, {54, -28, -46}, {66, 28, 26}, 5, 4);
  mesh.box("grey", Axis::z, {-50, -28, -46}, {-38, 28, 26}, 5, 4);
  return mesh;
}

LinkMesh shoulder_pitch() {
  LinkMesh mesh;
  mesh.motor("white", Axis::y, {0, 0, 0}, 46, -36, 2, 5);
  mesh.box("grey", Axis::x, {-50, -30, -30}, {-36, 34, 30}, 12, 4);
  return mesh;
}

LinkMesh shoulder_roll() {
  LinkMesh mesh;
  mesh.motor("dark", Axis::x, {0, 0, 0}, 32, -38, 38, 4);
  mesh.motor("orange", Axis::x, {0, 0, 0}, 36, 16, 32, 3);
  mesh.motor("white", Axis::z, {0, 0, -36}, 34, -10, 12, 4);
  return mesh;
}

LinkMesh upper_arm() {
  LinkMesh mesh;
  mesh.loft("white", Axis::z,
            {{-186, 0, 0, 28, 29, 16},
             {-172, 0, 0, 34, 35, 18},
             {-100, 0, 0, 38, 38, 20},
             {-58, 0, 0, 35, 35, 20},
             {-46, 0, 0, 28, 28, 18}});
  for (const double side : {1.0, -1.0})
    mesh.box("grey", Axis::z, {-22, side * 36 - 4, -242}, {22, side * 36 + 4, -160}, 5, 8);
  mesh.motor("dark", Axis::y, {0, 0, -220}, 24, -42, 42, 4);
  return mesh;
}

LinkMesh elbow() {
  LinkMesh mesh;
  mesh.motor("white", Axis::y, {0, 0, 0}, 32, -31, 31, 4);
  mesh.loft("white", Axis::z,
            {{-86, 0, 0, 28, 28, 18}, {-78, 0, 0, 31, 31, 20}, {-24, 0, 0, 30, 30, 18}});
  return mesh;
}

LinkMesh forearm() {
  LinkMesh mesh;
  mesh.motor("orange", Axis::z, {0, 0, 0}, 29, -10, 4, 3);
  mesh.loft("white", Axis::z,
            {{-80, 0, 0, 20, 22, 14}, {-70, 0, 0, 24, 25, 16}, {-10, 0, 0, 27, 27, 18}});
  for (const double side : {1.0, -1.0})
    mesh.box("grey", Axis::z, {-14, side * 24 - 3, -114}, {14, side * 24 + 3, -66}, 4, 5);
  return mesh;
}

LinkMesh wrist() {
  LinkMesh mesh;
  mesh.motor("dark", Axis::y, {0, 0, 0}, 16, -28, 28, 3);
  mesh.motor("dark", Axis::x, {0, 0, 0}, 15, -22, 22, 3);
  return mesh;
}

LinkMesh hand() {
  LinkMesh mesh;
  mesh.loft("white", Axis::z,
            {{-78, 0, 0, 15, 36, 12},
             {-70, 0, 0, 17, 38, 14},
             {-36, 0, 0, 18, 36, 14},
             {-18, 0, 0, 16, 24, 12}});
  for (const double finger : {-26.0, -9.0, 9.0, 26.0})
    mesh.box("dark", Axis::z, {-8, finger - 7, -122}, {8, finger + 7, -74}, 5, 4);
  mesh.box("dark", Axis::z, {6, -44, -84}, {22, -32, -40}, 5, 4);
  return mesh;
}

LinkMesh neck() {
  LinkMesh mesh;
  mesh.motor("dark", Axis::y, {0, 0, 0}, 18, -32, 32, 3);
  mesh.motor("grey", Axis::z, {0, 0, 20}, 22, -10, 8, 3);
  return mesh;
}

LinkMesh neck_yaw() {
  LinkMesh mesh;
  mesh.motor("dark", Axis::z, {0, 0, 14}, 24, -14, 14, 3);
  return mesh;
}

LinkMesh neck_roll() {
  LinkMesh mesh;
  mesh.motor("dark", Axis::x, {0, 0, 0}, 16, -30, 30, 3);
  mesh.motor("dark", Axis::y, {0, 0, 0}, 15, -38, 38, 3);
  return mesh;
}

LinkMesh head() {
  LinkMesh mesh;
  mesh.loft("white", Axis::z,
            {{2, 6, 0, 46, 46, 30},
             {22, 10, 0, 72, 64, 44},
             {84, 10, 0, 80, 72, 52},
             {126, 8, 0, 70, 64, 50},
             {148, 4, 0, 44, 42, 36},
             {155, 2, 0, 20, 20, 18}});
  mesh.loft("visor", Axis::x,
            {{76, 0, 84, 58, 24, 18}, {90, 0, 84, 52, 20, 16}, {94, 0, 84, 44, 15, 13}});
  for (const double side : {1.0, -1.0})
    mesh.motor("orange", Axis::y, {6, side * 70, 72}, 26, -6, 6, 2);
  return mesh;
}

}  // namespace

RobotMeshes humanoid30() {
  return {.title = "humanoid30",
          .source = "app/tools/make_humanoid30_meshes.cpp",
          .name = "humanoid30",
          .middle = {{"torso", torso()},
                     {"neck_link", neck()},
                     {"neck_yaw_link", neck_yaw()},
                     {"neck_roll_link", neck_roll()},
                     {"head", head()}},
          .sided = {{"hip_yaw_link", hip_yaw()},
                    {"hip_roll_link", hip_roll()},
                    {"thigh", thigh()},
                    {"shank", shank()},
                    {"ankle_link", ankle()},
                    {"foot", foot()},
                    {"shoulder_pitch_link", shoulder_pitch()},
                    {"shoulder_roll_link", shoulder_roll()},
                    {"upper_arm", upper_arm()},
                    {"elbow_link", elbow()},
                    {"forearm", forearm()},
                    {"wrist_link", wrist()},
                    {"hand", hand()}},
          .materials = {{"white", {0.86, 0.86, 0.84}},
                        {"orange", {0.85, 0.42, 0.12}},
                        {"grey", {0.46, 0.48, 0.52}},
                        {"dark", {0.15, 0.16, 0.19}},
                        {"visor", {0.04, 0.05, 0.08}}}};
}

}  // namespace ayumi::tools

int main(int argc, char** argv) {
  return ayumi::tools::write_meshes(argc, argv, ayumi::tools::humanoid30());
}
