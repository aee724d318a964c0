// Frames of HOAP-1 walking on its ground at 1280x720 with a shadow, read back as bytes, compared
// with MuJoCo's off-screen renderer on OSMesa with the same triangles in the same poses; also clips
// with encoding. Compare with --benchmark_repetitions=5
// --benchmark_enable_random_interleaving=true.

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/render/clip.hpp"
#include "ayumi/render/robot_surface.hpp"
#ifdef AYUMI_HAS_MUJOCO
#include <GL/osmesa.h>
#include <mujoco/mujoco.h>
#endif

#ifdef AYUMI_HAS_MUJOCO
// MuJoCo asks the process for OpenGL by EGL before it asks by OSMesa; here both are answered by
// OSMesa.
extern "C" OSMESAproc eglGetProcAddress(const char* name) { return OSMesaGetProcAddress(name); }
#endif

namespace ayumi {
namespace {

constexpr int kWidth = 1280, kHeight = 720, kFrames = 64;

/// HOAP-1 swinging legs and arms while it moves ahead; the motion does not need to be physical.
struct Walk {
  Walk() : model(load_robot(AYUMI_SOURCE_DIR "/robots/hoap1", {}, {.meshes = true})) {
    surface = robot_surface(model);
    log.joints = model.dof_names();
    log.controller = ControllerKind::dtad;
    log.dt = 1.0 / 30;
    for (int k = 0; k < kFrames; ++k) {
      SimulationSample s;
      s.state = model.rest_state();
      s.state.base.position = {0.01 * k, 0, 0.28};
      for (int i = 0; i < model.dof_count(); ++i) s.state.theta[i] += 0.2 * std::sin(0.3 * k + i);
      s.cog = s.command_cog = s.state.base.position;
      s.zmp = s.reference_zmp = {0.01 * k, 0, 0};
      s.fz = 64;
      s.command_theta = s.torque = s.state.theta;
      s.foot_force = {Eigen::Vector3d(0, 0, 32), Eigen::Vector3d(0, 0, 32)};
      log.samples.push_back(s);
      poses.push_back(body_poses(model, s.state));
    }
  }
  RobotModel model;
  SimulationLog log;
  std::vector<BodySurface> surface;
  std::vector<std::vector<Eigen::Isometry3d>> poses;
};

Camera camera_of(const Walk& walk, int k) {
  Camera camera;
  camera.target = walk.log.samples[size_t(k)].cog;
  camera.eye = camera.target + Eigen::Vector3d(0.95, -0.9, 0.35);
  return camera;
}

void frame(benchmark::State& run, bool antialias) {
  const Walk walk;
  Renderer renderer(walk.surface, {.width = kWidth, .height = kHeight, .antialias = antialias});
  int k = 0;
  for (auto _ : run) {
    Scene scene;
    scene.poses = walk.poses[size_t(k)];
    scene.camera = camera_of(walk, k);
    benchmark::DoNotOptimize(renderer.render(scene).rgb.data());
    k = (k + 1) % kFrames;
  }
}
BENCHMARK_CAPTURE(frame, plain, false)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(frame, antialiased, true)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// A clip with marks, caption and encoding on all cores; the result is in seconds per second of the
/// clip.
void clip(benchmark::State& run, bool antialias) {
  const Walk walk;
  const auto file = std::filesystem::temp_directory_path() / "ayumi_bench.mp4";
  ClipOptions options;
  options.picture.antialias = antialias;
  options.threads = 2;
  for (auto _ : run) write_clip(walk.model, walk.log, file, options);
  std::filesystem::remove(file);
  run.counters["s_per_clip_s"] =
      benchmark::Counter(double(run.iterations()) * (kFrames - 1) / 30,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(clip, draft, false)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK_CAPTURE(clip, quality, true)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

/// The peak memory of a process that draws a clip of the walk, repeated this many times.
void memory(benchmark::State& run) {
  Walk walk;
  const std::vector<SimulationSample> once = walk.log.samples;
  for (int i = 1; i < run.range(0); ++i)
    walk.log.samples.insert(walk.log.samples.end(), once.begin(), once.end());
  const auto file = std::filesystem::temp_directory_path() / "ayumi_bench.mp4";
  ClipOptions options;
  options.picture.width = 640;
  options.picture.height = 360;
  for (auto _ : run) write_clip(walk.model, walk.log, file, options);
  std::filesystem::remove(file);
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  run.counters["peak_MB"] = double(used.ru_maxrss) / 1024;
}
BENCHMARK(memory)
    ->Arg(2)
    ->Arg(19)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

#ifdef AYUMI_HAS_MUJOCO

/// A binary STL file of one body's triangles.
void write_stl(const std::filesystem::path& file, const BodySurface& body) {
  Triangles all;
  for (const Triangles* part : parts_of(body)) append(all, *part);
  std::ofstream out(file, std::ios::binary);
  out.write(std::string(80, ' ').data(), 80);
  const auto count = static_cast<std::uint32_t>(all.indices.size() / 3);
  out.write(reinterpret_cast<const char*>(&count), 4);
  for (size_t i = 0; i < all.indices.size(); i += 3) {
    const float none[3] = {};
    out.write(reinterpret_cast<const char*>(none), 12);
    for (size_t k = 0; k < 3; ++k)
      out.write(reinterpret_cast<const char*>(all.vertices[all.indices[i + k]].position.data()),
                12);
    out.write("\0\0", 2);
  }
}

/// Every body is a mocap body with its triangles, above a plane, with a light that casts shadows.
std::string mujoco_scene(const Walk& walk, const std::filesystem::path& folder) {
  std::string assets, bodies;
  for (size_t i = 0; i < walk.surface.size(); ++i) {
    if (parts_of(walk.surface[i])[0]->indices.empty() &&
        parts_of(walk.surface[i])[1]->indices.empty())
      continue;
    const std::string name = "body" + std::to_string(i);
    write_stl(folder / (name + ".stl"), walk.surface[i]);
    assets += "<mesh name=\"" + name + "\" file=\"" + (folder / (name + ".stl")).string() + "\"/>";
    bodies += "<body name=\"" + name + "\" mocap=\"true\"><geom type=\"mesh\" mesh=\"" + name +
              "\" contype=\"0\" conaffinity=\"0\"/></body>";
  }
  return "<mujoco><visual><global offwidth=\"1280\" offheight=\"720\"/><quality offsamples=\"0\" "
         "shadowsize=\"1024\"/></visual><asset>" +
         assets +
         "<texture name=\"grid\" type=\"2d\" builtin=\"checker\" width=\"256\" height=\"256\" "
         "rgb1=\".6 .6 .6\" rgb2=\".55 .55 .55\"/><material name=\"grid\" texture=\"grid\" "
         "texrepeat=\"10 10\"/></asset><worldbody><light pos=\"0 -1 3\" dir=\"0 .3 -1\" "
         "directional=\"true\" castshadow=\"true\"/><geom type=\"plane\" size=\"5 5 .1\" "
         "material=\"grid\"/>" +
         bodies + "</worldbody></mujoco>";
}

void mujoco_frame(benchmark::State& run) {
  const Walk walk;
  const auto folder = std::filesystem::temp_directory_path() / "ayumi_bench_mujoco";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "scene.xml") << mujoco_scene(walk, folder);
  char error[500] = "";
  mjModel* model = mj_loadXML((folder / "scene.xml").c_str(), nullptr, error, sizeof error);
  if (!model) return run.SkipWithError(error);
  OSMesaContext context = OSMesaCreateContextExt(GL_RGBA, 24, 8, 8, nullptr);
  std::vector<unsigned char> buffer(size_t(4) * 800 * 800);
  if (!context || !OSMesaMakeCurrent(context, buffer.data(), GL_UNSIGNED_BYTE, 800, 800))
    return run.SkipWithError("no OSMesa context");
  mjData* data = mj_makeData(model);
  mjvScene scene;
  mjvCamera camera;
  mjvOption option;
  mjrContext drawing;
  mjv_defaultScene(&scene);
  mjv_defaultCamera(&camera);
  mjv_defaultOption(&option);
  mjr_defaultContext(&drawing);
  mjv_makeScene(model, &scene, 200);
  mjr_makeContext(model, &drawing, 50);
  mjr_setBuffer(mjFB_OFFSCREEN, &drawing);
  scene.flags[mjRND_SHADOW] = 1;
  scene.flags[mjRND_REFLECTION] = 0;
  const mjrRect view = {0, 0, kWidth, kHeight};
  std::vector<unsigned char> pixels(size_t(3) * kWidth * kHeight);
  int k = 0;
  for (auto _ : run) {
    for (size_t i = 0; i < walk.poses[size_t(k)].size(); ++i) {
      const int body = mj_name2id(model, mjOBJ_BODY, ("body" + std::to_string(i)).c_str());
      if (body < 0) continue;
      const int mocap = model->body_mocapid[body];
      const Eigen::Isometry3d& pose = walk.poses[size_t(k)][i];
      const Eigen::Quaterniond q(pose.linear());
      for (int c = 0; c < 3; ++c) data->mocap_pos[3 * mocap + c] = pose.translation()[c];
      const double turn[] = {q.w(), q.x(), q.y(), q.z()};
      std::copy_n(turn, 4, data->mocap_quat + 4 * mocap);
    }
    mj_kinematics(model, data);
    mj_comPos(model, data);
    mj_camlight(model, data);
    const Camera ours = camera_of(walk, k);
    camera.lookat[0] = ours.target.x();
    camera.lookat[1] = ours.target.y();
    camera.lookat[2] = ours.target.z();
    camera.distance = (ours.eye - ours.target).norm();
    camera.azimuth = 136;
    camera.elevation = -15;
    mjv_updateScene(model, data, &option, nullptr, &camera, mjCAT_ALL, &scene);
    mjr_render(view, &scene, &drawing);
    mjr_readPixels(pixels.data(), nullptr, view, &drawing);
    benchmark::DoNotOptimize(pixels.data());
    k = (k + 1) % kFrames;
  }
  if (const char* file = std::getenv("AYUMI_BENCH_PICTURE")) {
    Image image{kWidth, kHeight, std::vector<std::uint8_t>(pixels.size())};
    for (int y = 0; y < kHeight; ++y)
      std::copy_n(&pixels[size_t(3) * kWidth * (kHeight - 1 - y)], 3 * kWidth, image.pixel(0, y));
    write_png(file, image);
  }
  mjr_freeContext(&drawing);
  mjv_freeScene(&scene);
  mj_deleteData(data);
  mj_deleteModel(model);
  OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
  OSMesaDestroyContext(context);
  std::filesystem::remove_all(folder);
}
BENCHMARK(mujoco_frame)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

#endif

/// A reporter that prints at the end how the median frames compare.
class WithRatio : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      if (run.run_type == Run::RT_Iteration)
        times_[run.run_name.function_name + "/" + run.run_name.args].push_back(
            run.GetAdjustedCPUTime());
    ConsoleReporter::ReportRuns(runs);
  }
  void Finalize() override {
    const double peer = median("mujoco_frame/"), plain = median("frame/plain/"),
                 quality = median("frame/antialiased/");
    if (plain <= 0) return;
    std::printf("\n1280x720 with shadow, median processor time per frame: %.1f ms", plain);
    if (quality > 0) std::printf(", antialiased %.1f ms", quality);
    if (peer > 0) std::printf("; MuJoCo %.1f ms: %.2f times Ayumi's", peer, peer / plain);
    std::printf("\n");
  }

 private:
  double median(const std::string& name) {
    std::vector<double>& all = times_[name];
    std::sort(all.begin(), all.end());
    return all.empty() ? 0 : all[all.size() / 2];
  }
  std::map<std::string, std::vector<double>> times_;
};

}  // namespace
}  // namespace ayumi

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  ayumi::WithRatio reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return 0;
}
