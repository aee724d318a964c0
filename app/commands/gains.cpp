// Design of gains: computes the gains of DTAD from times that the user states. Also shows the
// stability of the whole loop, and from which disturbances the robot can then recover.

#include <memory>
#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/study/gain_study.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

namespace {

using Complex = std::complex<double>;
using Json = nlohmann::ordered_json;

// Modes that decay more slowly than this share of omega are not shown. Chosen: they last longer
// than any motion.
constexpr double kShown = 1e-3;

struct GainsCommand {
  std::string robot;
  std::vector<double> poles, time_constants;
  double frequency = 0, damping = 0;
  GainWishes wishes;
  std::vector<std::string> gains;
  std::optional<double> latency;
};

void read_wishes(GainsCommand& options) {
  const int given = !options.poles.empty() + !options.time_constants.empty() +
                    (options.frequency != 0 || options.damping != 0);
  if (given > 1)
    fail(ErrorCode::usage,
         "the poles are given more than once. Use only one of --poles, --time-constants, and "
         "--frequency with --damping");
  if (!options.poles.empty())
    options.wishes.poles = {{{Complex(options.poles[0]), Complex(options.poles[1])}}};
  for (const double t : options.time_constants)
    if (!(t > 0))
      fail(ErrorCode::usage,
           "--time-constants: " + text::brief(t) + " s is not possible. Give a time above 0 s");
  if (!options.time_constants.empty())
    options.wishes.poles = {
        {Complex(-1 / options.time_constants[0]), Complex(-1 / options.time_constants[1])}};
  if (options.frequency != 0 || options.damping != 0) {
    if (!(options.frequency > 0) || !(options.damping > 0))
      fail(ErrorCode::usage, "give --frequency and --damping together, both above 0");
    const double w = 2 * M_PI * options.frequency, d = options.damping;
    const Complex root = std::sqrt(Complex(d * d - 1));
    options.wishes.poles = {{w * (-d + root), w * (-d - root)}};
  }
}

std::string mode_text(const Complex& pole) {
  std::string line = std::string(pole.real() < 0 ? "  decays" : "  grows") +
                     " with the time constant " + text::brief(std::abs(1 / pole.real())) + " s";
  if (std::abs(pole.imag()) > 1e-6)
    line += " and oscillates at " + text::fixed(std::abs(pole.imag()) / (2 * M_PI), 2) + " Hz";
  return line + "\n";
}

std::string report(const RobotModel& model, const GainStudy& d) {
  const DtadParams& p = d.params;
  const double w = d.omega;
  std::string out = model.name() + ": COG " + text::fixed(d.loops.front().height, 3) +
                    " m above the soles, omega = sqrt(g / COG height) = " + text::fixed(w, 2) +
                    " /s\n";
  out += "gains, as a pattern or a sidecar names them:\n ";
  for (const auto& [name, value] : gain_list(p)) out += " " + name + "=" + text::brief(value);
  out +=
      "\nlong term   K = " + text::brief(long_term_k(p)) +
      ", D = " + text::fixed(1e3 * long_term_d(p) / w, 1) +
      " ms: the reference ZMP moves by K times the error of the COG plus D times the rate of this "
      "error, equations (18)(19)\n";
  out += "short term  " + text::fixed(100 * p.zmp_gain / (1 + p.zmp_gain), 0) +
         " % of a ZMP error is answered immediately. The time constant of the ZMP filter is " +
         text::fixed(1e3 * p.zmp_filter / w, 1) + " ms\n";
  out += "return      the reference returns to the command within " +
         text::fixed(1e3 / (w * p.pull_rate), 0) + " ms";
  out += p.offset_time > 0 ? ". A constant ZMP offset is accepted as normal after " +
                                 text::fixed(1e3 * p.offset_time / w, 0) + " ms\n"
                           : ". A constant ZMP offset is never accepted as normal\n";
  const LoopModel& weakest = d.loops[d.weakest.index];
  out += "the loop with sensors and servos that are " + text::brief(1e3 * weakest.delay) +
         " ms late is stable while the robot stands on both feet, and while it stands on one foot "
         "for the time of a step. The loop stays stable " +
         (d.largest_ka >= GainStudy::kMostKa ? "for ka beyond " + text::brief(GainStudy::kMostKa)
                                             : "for ka up to " + text::fixed(d.largest_ka, 2)) +
         ". These are the slowest modes of an error (" + name_of(weakest) + "):\n";
  int shown = 0;
  for (const Complex& pole : d.weakest.analysis.poles)
    if (pole.imag() >= 0 && -pole.real() > kShown * w && shown++ < 4) out += mode_text(pole);
  out += "largest error of the DCM that needs no step, and the impulse that causes this error:\n";
  for (const Reach& r : d.reaches)
    out += "  " + r.support + ", " + r.direction + ": " + text::fixed(1e3 * r.dcm, 1) + " mm, " +
           text::fixed(r.impulse, 2) + " N s\n";
  return out;
}

Json json_of(const RobotModel& model, const GainStudy& d) {
  Json gains = Json::object(), poles = Json::array(), reach = Json::array();
  for (const auto& [name, value] : gain_list(d.params)) gains[name] = value;
  for (const Complex& pole : d.weakest.analysis.poles) poles.push_back({pole.real(), pole.imag()});
  for (const Reach& r : d.reaches)
    reach.push_back({{"support", r.support},
                     {"direction", r.direction},
                     {"dcm_m", r.dcm},
                     {"impulse_Ns", r.impulse}});
  return {{"robot", model.name()},
          {"omega_1_s", d.omega},
          {"gains", gains},
          {"K", long_term_k(d.params)},
          {"D_s", long_term_d(d.params) / d.omega},
          {"stable", d.weakest.analysis.stable},
          {"decay_1_s", d.weakest.analysis.decay},
          {"frequency_Hz", d.weakest.analysis.frequency},
          {"largest_stable_ka", d.largest_ka},
          {"poles_1_s", poles},
          {"recoverable", reach}};
}

void print_gains(Context& context, GainsCommand& options) {
  read_wishes(options);
  const RobotModel model = load_robot(options.robot, robot_search(context));
  const auto gains = read_pairs(options.gains, "--gain");
  const GainStudy d =
      study_gains(model, options.wishes, {gains.begin(), gains.end()}, options.latency);
  refuse_unstable(d.loops, d.params);
  context.print(report(model, d));
  context.print_json(json_of(model, d).dump(2));
}

}  // namespace

void add_gains(Command& app, Context& context) {
  Command* command =
      app.add_subcommand("gains", "compute gains of DTAD and say whether the whole loop is stable");
  command->footer(
      "Examples:\n"
      "  ayumi gains hoap1\n"
      "  ayumi gains hoap1 --time-constants 0.16,0.64 --absorb 0.6 --return-time 0.1\n"
      "  ayumi gains hoap1 --frequency 1 --damping 1 --latency 0.005\n"
      "Unstable gains are refused, and the reason is printed. A gain that is not given keeps the "
      "value in the robot's sidecar.");
  auto options = std::make_shared<GainsCommand>();
  command
      ->add_option("ROBOT", options->robot,
                   "Name of a bundled robot, or a folder, sidecar or robot file (URDF, MJCF, SDF, "
                   "Choreonoid body, mi-lib ztk).")
      ->required();
  command
      ->add_option("--poles", options->poles,
                   "Two real poles of the COG [1/s], for example -6.3,-1.6.")
      ->delimiter(',')
      ->expected(2)
      ->type_name("P1,P2");
  command
      ->add_option("--time-constants", options->time_constants,
                   "Two time constants of the COG [s], in place of poles.")
      ->delimiter(',')
      ->expected(2)
      ->type_name("T1,T2");
  command
      ->add_option("--frequency", options->frequency,
                   "Frequency of a pair of poles [Hz], together with --damping.")
      ->type_name("F");
  command
      ->add_option("--damping", options->damping,
                   "Damping ratio of the pair of poles of --frequency.")
      ->type_name("Z");
  command
      ->add_option(
          "--absorb", options->wishes.absorb,
          "Short-term absorption: fraction (0..1) of a ZMP error that is answered immediately.")
      ->type_name("X");
  command
      ->add_option("--return-time", options->wishes.return_time,
                   "Time constant with which the reference returns to the command [s].")
      ->type_name("T");
  command
      ->add_option("--zmp-filter", options->wishes.zmp_filter,
                   "Time constant of the filter of the measured ZMP [s].")
      ->type_name("T");
  command
      ->add_option("--forget", options->wishes.forget,
                   "Time after which a constant ZMP offset is accepted as normal [s]; 0 = never.")
      ->type_name("T");
  command->add_option("--gain", options->gains, "Set a gain by its name.")
      ->type_name("GAIN=VALUE")
      ->allow_extra_args(false);
  command
      ->add_option("--latency", options->latency,
                   "Latency of the sensors [s] (default: the latency in the robot's sidecar).")
      ->check(number_within(0.0, GainStudy::kMostLatency).description(""))
      ->type_name("T");
  command->callback([options, &context] { print_gains(context, *options); });
}

}  // namespace ayumi::app
