#include "ayumi/render/clip.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdio>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/render/log_reading.hpp"
#include "tests/render/box_robot.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;

class Clip : public testing::Test {
 protected:
  Clip() {
    folder =
        fs::temp_directory_path() / ("ayumi_clip_" + std::to_string(getpid()) + "_" +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder);
    options.picture = {.width = 160, .height = 120, .antialias = false};
  }
  ~Clip() override { fs::remove_all(folder); }

  std::string message_of(const fs::path& path, ErrorCode code) {
    try {
      write_clip(model, log, path, options);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      return error.what();
    }
    ADD_FAILURE() << "no error";
    return "";
  }

  size_t files() const {
    return static_cast<size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }

  RobotModel model = test::box_robot();
  SimulationLog log = test::box_run(model);
  ClipOptions options;
  fs::path folder;
};

std::string output_of(const std::string& command) {
  std::string out;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 256> buffer;
  while (fgets(buffer.data(), buffer.size(), pipe)) out += buffer.data();
  pclose(pipe);
  return out;
}

TEST_F(Clip, EveryFormatHasItsFramesAndSize) {
  for (const std::string name : {"a.mp4", "a.webm", "a.gif"}) {
    const fs::path path = folder / name;
    options.fps = 25;
    const ClipSummary summary = write_clip(model, log, path, options);
    EXPECT_EQ(summary.frames, 26) << "0 to 1 s, both included";
    EXPECT_EQ(output_of("ffprobe -v error -count_frames -select_streams v -show_entries "
                        "stream=width,height,r_frame_rate,nb_read_frames -of csv=p=0 " +
                        path.string()),
              "160,120,25/1,26\n")
        << name;
  }
  EXPECT_EQ(output_of("ffprobe -v error -show_entries stream=codec_name,pix_fmt -of csv=p=0 " +
                      (folder / "a.mp4").string()),
            "h264,yuv420p\n");
}

TEST_F(Clip, SameBytesForAnyNumberOfThreads) {
  std::string first;
  for (const int threads : {1, 1, 3}) {
    options.threads = threads;
    write_clip(model, log, folder / "a.mp4", options);
    const std::string bytes = read_file(folder / "a.mp4");
    if (first.empty()) first = bytes;
    EXPECT_EQ(bytes, first) << threads;
  }
  EXPECT_EQ(first.find(folder.string()), std::string::npos);
}

TEST_F(Clip, AFolderOfFramesHoldsExactTimes) {
  options.fps = 4;
  options.begin = 0.25;
  const ClipSummary summary = write_clip(model, log, folder / "frames", options);
  EXPECT_EQ(summary.frames, 4);
  ClipRenderer renderer(model, log, options);
  for (int k = 0; k < 4; ++k)
    EXPECT_EQ(read_file(folder / "frames" / ("frame_0000" + std::to_string(k) + ".png")),
              encode_png(renderer.clip_frame(0.25 + k * 0.25)))
        << k;
  EXPECT_NE(message_of(folder / "frames", ErrorCode::bad_file).find("already exists"),
            std::string::npos);
}

TEST_F(Clip, AFolderOfFramesReplacesFramesAlone) {
  options.fps = 4;
  options.overwrite = true;
  const fs::path frames = folder / "frames";
  write_clip(model, log, frames, options);
  options.end = 0.5;
  EXPECT_EQ(write_clip(model, log, frames, options).frames, 3);
  EXPECT_EQ(std::distance(fs::directory_iterator(frames), fs::directory_iterator()), 3);
  // A file of the user is kept, and so are the frames beside it, even if its name is similar to
  // that of a frame.
  for (const char* name : {"notes.txt", "frame_title.png", "frame_00001.jpg", "frame_00001b.png"}) {
    const std::string before = read_file(frames / "frame_00000.png");
    write_file(frames / name, "mine");
    options.begin = 0.25;
    EXPECT_NE(message_of(frames, ErrorCode::bad_file).find("already exists"), std::string::npos)
        << name;
    EXPECT_EQ(read_file(frames / name), "mine");
    EXPECT_EQ(read_file(frames / "frame_00000.png"), before);
    fs::remove(frames / name);
  }
}

TEST_F(Clip, AFolderOfFramesLeavesItsNeighboursAlone) {
  options.fps = 2;
  fs::create_directory(folder / "frames.part");
  write_file(folder / "frames.part" / "mine", "text");
  write_clip(model, log, folder / "frames", options);
  EXPECT_EQ(read_file(folder / "frames.part" / "mine"), "text");
  EXPECT_EQ(files(), 2u) << "no temporary folder stays";
}

TEST_F(Clip, SlowMotionHasMoreFrames) {
  options.fps = 10;
  options.speed = 0.25;
  EXPECT_EQ(write_clip(model, log, folder / "a.mp4", options).frames, 41);
}

TEST_F(Clip, ASinglePictureShowsItsInstant) {
  options.at = 0.5;
  write_clip(model, log, folder / "a.png", options);
  EXPECT_EQ(read_file(folder / "a.png"), encode_png(ClipRenderer(model, log, options).frame(0.5)));
}

TEST_F(Clip, ASinglePictureWithoutATimeShowsWhatHappens) {
  const ClipSummary summary = write_clip(model, log, folder / "a.png", options);
  const double t = telling_instant(log);
  EXPECT_EQ(summary.at, t);
  EXPECT_NEAR(t, 0.55, 1e-12) << "after the push";
  EXPECT_EQ(read_file(folder / "a.png"), encode_png(ClipRenderer(model, log, options).frame(t)));
}

TEST_F(Clip, CaptionAndMarksCanBeSwitchedOff) {
  ClipRenderer with(model, log, options);
  options.overlay.caption = false;
  ClipRenderer without(model, log, options);
  const Image a = with.frame(0.5), b = without.frame(0.5);
  int changed = 0, changed_middle = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const bool differs = a.pixel(x, y)[0] != b.pixel(x, y)[0];
      changed += differs;
      changed_middle += differs && y > 30 && y < 90;
    }
  EXPECT_GT(changed, 500);
  EXPECT_EQ(changed_middle, 0);
}

TEST_F(Clip, ALongTitleLeavesRoomForTheTime) {
  options.title = std::string(400, 'A');
  const ClipRenderer renderer(model, log, options);
  const auto line_at = [&](double t) {
    Image line{640, 30, std::vector<std::uint8_t>(3 * 640 * 30, 255)};
    renderer.write_title(line, 0, 12, t);
    return line.rgb;
  };
  EXPECT_NE(line_at(0.1), line_at(0.2));
}

TEST_F(Clip, ThePushStaysVisibleForAWhile) {
  options.overlay = test::no_marks();
  options.overlay.push = true;
  const auto pink = [](const Image& image) {
    int count = 0;
    for (size_t i = 0; i < image.rgb.size(); i += 3)
      count += image.rgb[i] > image.rgb[i + 1] + 40 && image.rgb[i + 2] > image.rgb[i + 1] + 20;
    return count;
  };
  ClipRenderer renderer(model, log, options);
  EXPECT_EQ(pink(renderer.frame(0.298)), 0);
  EXPECT_GT(pink(renderer.frame(0.300)), 100);
  EXPECT_GT(pink(renderer.frame(0.700)), 60) << "0.4 s after its start";
  EXPECT_EQ(pink(renderer.frame(0.901)), 0);
}

// The legend of a picture names a push if the picture shows one; that of a clip names it if one of
// its pictures does.
TEST_F(Clip, TheLegendNamesAPushWhereOneIsShown) {
  ClipOptions without_pushes = options;
  without_pushes.overlay.push = false;
  ClipRenderer with(model, log, options), without(model, log, without_pushes);
  EXPECT_EQ(with.frame(0.1).rgb, without.frame(0.1).rgb) << "before the push";
  EXPECT_NE(with.clip_frame(0.1).rgb, without.clip_frame(0.1).rgb);
  const auto legend = [&](ClipRenderer& renderer) {
    Image line{640, 30, std::vector<std::uint8_t>(3 * 640 * 30, 255)};
    renderer.write_legend(&line, 640, 0, 12);
    return line.rgb;
  };
  for (const double t : {0.1, 0.4}) {
    with.frame_robot({0.0, t});
    without.frame_robot({0.0, t});
    EXPECT_EQ(legend(with) == legend(without), t < 0.3) << t;
  }
  options.begin = without_pushes.begin = 0.95;  // the push has faded
  EXPECT_EQ(ClipRenderer(model, log, options).clip_frame(1).rgb,
            ClipRenderer(model, log, without_pushes).clip_frame(1).rgb);
}

TEST_F(Clip, ErrorsSayWhatIsWrongAndLeaveNothing) {
  EXPECT_NE(message_of(folder / "missing" / "a.mp4", ErrorCode::bad_file).find("does not exist"),
            std::string::npos);
  EXPECT_NE(
      message_of(folder / "a.avi", ErrorCode::usage).find("'.avi' is not possible; give .mp4"),
      std::string::npos);
  options.speed = 1e-9;
  EXPECT_NE(message_of(folder / "a.mp4", ErrorCode::usage)
                .find("the clip would have 3e+10 frames, and at most 1e+06 are possible"),
            std::string::npos);
  options.speed = 1;
  options.threads = -1;
  EXPECT_NE(message_of(folder / "a.mp4", ErrorCode::usage).find("the number of threads is -1"),
            std::string::npos);
  options.threads = 1;
  options.encoder = "no-such-encoder";
  EXPECT_NE(message_of(folder / "a.mp4", ErrorCode::bad_file).find("install ffmpeg"),
            std::string::npos);
  options.encoder = "false";
  EXPECT_NE(message_of(folder / "a.mp4", ErrorCode::bad_file).find("false could not write"),
            std::string::npos);
  options.encoder = "ffmpeg";
  options.picture.width = 161;
  EXPECT_NE(message_of(folder / "a.mp4", ErrorCode::usage).find("even width"), std::string::npos);
  options.picture.width = 0;
  EXPECT_NE(message_of(folder / "a.png", ErrorCode::usage).find("0x120"), std::string::npos);
  options.picture.width = 160;
  options.at = 2;
  EXPECT_NE(message_of(folder / "a.png", ErrorCode::usage).find("outside the run (0 to 1 s)"),
            std::string::npos);
  options.at = 0;
  log.samples.clear();
  EXPECT_NE(message_of(folder / "a.png", ErrorCode::usage).find("no samples"), std::string::npos);
  EXPECT_EQ(files(), 0u);
}

TEST_F(Clip, EncoderMessagesAreHandedOn) {
  const fs::path script = folder / "encoder.sh";
  write_file(script, "#!/bin/sh\necho 'No space left on device' >&2\nexit 1\n");
  fs::permissions(script, fs::perms::owner_all);
  options.encoder = script.string();
  EXPECT_EQ(message_of(folder / "a.mp4", ErrorCode::bad_file),
            (folder / "a.mp4").string() + ": " + script.string() +
                " could not write the clip: No space left on device");
  EXPECT_EQ(files(), 1u);
}

// ffmpeg ends without an error although its file was cut off.
TEST_F(Clip, AFullDiskLeavesNoHalfClip) {
  const fs::path script = folder / "encoder.sh";
  write_file(script, "#!/bin/sh\ntrap '' XFSZ\nulimit -f 4\nexec ffmpeg \"$@\"\n");
  fs::permissions(script, fs::perms::owner_all);
  options.encoder = script.string();
  for (const char* name : {"a.mp4", "a.webm", "a.gif", "a.apng"})
    EXPECT_NE(message_of(folder / name, ErrorCode::bad_file).find("File too large"),
              std::string::npos)
        << name;
  EXPECT_EQ(files(), 1u);
}

TEST_F(Clip, StoppingLeavesNothing) {
  int calls = 0;
  EXPECT_THROW(write_clip(model, log, folder / "a.mp4", options,
                          [&](const ProgressEvent&) { return ++calls < 4; }),
               Interrupted);
  EXPECT_THROW(write_clip(model, log, folder / "frames", options,
                          [&](const ProgressEvent&) { return false; }),
               Interrupted);
  EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace ayumi
