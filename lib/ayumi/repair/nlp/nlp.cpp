#include "ayumi/repair/nlp/nlp.hpp"

#include <algorithm>
#include <coin/IpIpoptApplication.hpp>
#include <coin/IpTNLP.hpp>
#include <cstdlib>
#include <ctime>
#include <exception>

#include "ayumi/base/processor_time.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/repair/nlp/banded_kkt_solver.hpp"

namespace ayumi {

using Eigen::VectorXd;
using Ipopt::Index;
using Ipopt::Number;

namespace {

VectorXd vector(const Number* values, Index n) { return Eigen::Map<const VectorXd>(values, n); }

// Work for each nonzero of the Jacobian and the Hessian: for an evaluation of the constraints, for
// a derivative, and for the linear systems of an iteration. Measured: the shares of the time that a
// repair takes for them.
constexpr double kWorkOfValues = 1, kWorkOfDerivatives = 2, kWorkOfIteration = 4;

class Adapter : public Ipopt::TNLP {
 public:
  Adapter(const Nlp& nlp, const NlpOptions& options, const Progress& progress,
          const std::string& stage)
      : nlp_(nlp), options_(options), progress_(progress), stage_(stage) {}

  NlpSolution solution;
  bool out_of_work = false;
  std::exception_ptr thrown;  // set by a callback; Ipopt must not see exceptions

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian,
                    IndexStyleEnum& style) override {
    n = static_cast<Index>(nlp_.start.size());
    m = static_cast<Index>(nlp_.constraint_lower.size());
    jacobian = nlp_.jacobian.size();
    hessian = nlp_.hessian.size();
    style = TNLP::C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* xl, Number* xu, Index m, Number* gl, Number* gu) override {
    std::copy_n(nlp_.lower.data(), n, xl);
    std::copy_n(nlp_.upper.data(), n, xu);
    std::copy_n(nlp_.constraint_lower.data(), m, gl);
    std::copy_n(nlp_.constraint_upper.data(), m, gu);
    return true;
  }

  bool get_starting_point(Index n, bool, Number* x, bool bounds, Number* lower, Number* upper,
                          Index m, bool rows, Number* multipliers) override {
    std::copy_n(nlp_.start.data(), n, x);
    if (rows) std::copy_n(nlp_.start_multipliers.data(), m, multipliers);
    if (bounds) return guarded([&] { bound_multipliers(n, lower, upper); });
    return true;
  }

  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    return guarded([&] { value = nlp_.objective(vector(x, n)); });
  }

  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    return guarded([&] {
      VectorXd g = VectorXd::Zero(n);
      nlp_.gradient(vector(x, n), g);
      std::copy_n(g.data(), n, gradient);
    });
  }

  bool eval_g(Index n, const Number* x, bool, Index m, Number* values) override {
    add_work(kWorkOfValues);
    return guarded([&] {
      VectorXd g = VectorXd::Zero(m);
      nlp_.constraints(vector(x, n), g);
      std::copy_n(g.data(), m, values);
      note(vector(x, n), g);
    });
  }

  bool eval_jac_g(Index n, const Number* x, bool, Index, Index count, Index* rows, Index* columns,
                  Number* values) override {
    if (!values) return structure(nlp_.jacobian, rows, columns);
    add_work(kWorkOfDerivatives);
    return guarded([&] {
      VectorXd v = VectorXd::Zero(count);
      nlp_.jacobian_values(vector(x, n), v);
      std::copy_n(v.data(), count, values);
    });
  }

  bool eval_h(Index n, const Number* x, bool, Number scale, Index m, const Number* multipliers,
              bool, Index count, Index* rows, Index* columns, Number* values) override {
    if (!values) return structure(nlp_.hessian, rows, columns);
    add_work(kWorkOfDerivatives);
    return guarded([&] {
      VectorXd v = VectorXd::Zero(count);
      nlp_.hessian_values(vector(x, n), scale, vector(multipliers, m), v);
      std::copy_n(v.data(), count, values);
    });
  }

  bool intermediate_callback(Ipopt::AlgorithmMode, Index iteration, Number objective,
                             Number infeasibility, Number, Number, Number, Number, Number, Number,
                             Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    solution.iterations = iteration;
    add_work(kWorkOfIteration);
    out_of_work = solution.work >= options_.most_work;
    if (out_of_work) return false;
    if (!progress_) return true;
    const BandedKktPause pause;
    return progress_({stage_, static_cast<double>(iteration) / options_.max_iterations,
                      "iteration " + std::to_string(iteration) + ", violation " +
                          text::brief(infeasibility, 2) + ", change " + text::brief(objective, 4)});
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number*,
                         const Number*, Index m, const Number* g, const Number* multipliers,
                         Number value, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    solution.x = vector(x, n);
    solution.multipliers = vector(multipliers, m);
    solution.objective = value;
    solution.violation = 0;
    for (Index i = 0; i < m; ++i)
      solution.violation = std::max(
          {solution.violation, nlp_.constraint_lower[i] - g[i], g[i] - nlp_.constraint_upper[i]});
    for (Index i = 0; i < n; ++i)
      solution.violation =
          std::max({solution.violation, nlp_.lower[i] - x[i], x[i] - nlp_.upper[i]});
  }

 private:
  static bool structure(const SparsePattern& pattern, Index* rows, Index* columns) {
    std::copy(pattern.rows.begin(), pattern.rows.end(), rows);
    std::copy(pattern.columns.begin(), pattern.columns.end(), columns);
    return true;
  }

  // Multipliers of the bounds that make the gradient of the Lagrangian zero: z_lower - z_upper.
  void bound_multipliers(Index n, Number* lower, Number* upper) const {
    VectorXd sum = VectorXd::Zero(n), J = VectorXd::Zero(nlp_.jacobian.size());
    nlp_.gradient(nlp_.start, sum);
    nlp_.jacobian_values(nlp_.start, J);
    for (int k = 0; k < nlp_.jacobian.size(); ++k)
      sum[nlp_.jacobian.columns[k]] += J[k] * nlp_.start_multipliers[nlp_.jacobian.rows[k]];
    for (Index i = 0; i < n; ++i) {
      lower[i] = nlp_.lower[i] > -kNoBound ? std::max(0.0, sum[i]) : 0;
      upper[i] = nlp_.upper[i] < kNoBound ? std::max(0.0, -sum[i]) : 0;
    }
  }

  void add_work(double of_each) {
    solution.work += of_each * (nlp_.jacobian.size() + nlp_.hessian.size());
  }

  double violation(const VectorXd& g) const {
    return std::max(
        {0.0, (nlp_.constraint_lower - g).maxCoeff(), (g - nlp_.constraint_upper).maxCoeff()});
  }

  void note(const VectorXd& x, const VectorXd& g) {
    if (!options_.least_violating || g.size() == 0 || !g.allFinite()) return;
    const double size = violation(g);
    if (size >= least_) return;
    least_ = size;
    *options_.least_violating = x;
  }

  template <class Work>
  bool guarded(Work work) {
    if (thrown) return false;
    const BandedKktPause pause;
    const double begin = thread_seconds();
    try {
      work();
      solution.function_seconds += thread_seconds() - begin;
      return true;
    } catch (...) {
      thrown = std::current_exception();
      return false;
    }
  }

  const Nlp& nlp_;
  const NlpOptions& options_;
  const Progress& progress_;
  const std::string& stage_;
  double least_ = kNoBound;  // violation of *options_.least_violating
};

bool has_equalities(const Nlp& nlp) {
  return (nlp.constraint_lower.array() == nlp.constraint_upper.array()).any();
}

void set_linear_solver(Ipopt::OptionsList& list, bool banded) {
  list.SetStringValue("linear_solver", banded ? "ma27" : "mumps");
  if (!banded) return;
  list.SetStringValue("linear_system_scaling", "none");
  // The solver states exactly the memory that it needs.
  list.SetNumericValue("ma27_la_init_factor", 1);
  list.SetNumericValue("ma27_liw_init_factor", 1);
}

// Sets the options for a start that has multipliers. `push` is the distance that they and the start
// keep from their bounds.
void start_with_multipliers(Ipopt::OptionsList& list, double push) {
  list.SetStringValue("warm_start_init_point", "yes");
  for (const char* name :
       {"warm_start_bound_push", "warm_start_bound_frac", "warm_start_slack_bound_push",
        "warm_start_slack_bound_frac", "warm_start_mult_bound_push"})
    list.SetNumericValue(name, push);
}

// Ends a search that alternates between points on both sides of a kink, or whose multipliers grow
// because two rows say the same. Ipopt calls such a point acceptable.
void stop_where_still(Ipopt::OptionsList& list, const NlpOptions& options) {
  using namespace repair_policy::solver;
  list.SetIntegerValue("acceptable_iter", kKinkIterations);
  list.SetNumericValue("acceptable_obj_change_tol", options.still_change);
  list.SetNumericValue("acceptable_constr_viol_tol", options.constraint_tolerance);
  list.SetNumericValue("acceptable_compl_inf_tol", options.still_complementarity);
  for (const char* name : {"acceptable_tol", "acceptable_dual_inf_tol"})
    list.SetNumericValue(name, kKinkGradient);
}

void set_options(Ipopt::OptionsList& list, const NlpOptions& options) {
  list.SetStringValue("sb", "yes");  // no banner: the library never prints
  list.SetIntegerValue("print_level", 0);
  list.SetStringValue("option_file_name", "");  // no file is read from the working directory
  list.SetStringValue("hessian_approximation", "exact");
  list.SetStringValue("nlp_scaling_method", "none");  // the problems are already scaled
  list.SetStringValue("mu_strategy", "monotone");
  list.SetNumericValue("mu_init", options.start_barrier);
  list.SetNumericValue("mu_linear_decrease_factor", repair_policy::solver::kBarrierFactor);
  list.SetNumericValue("mu_superlinear_decrease_power", repair_policy::solver::kBarrierPower);
  for (const char* name : {"bound_push", "bound_frac", "slack_bound_push", "slack_bound_frac"})
    list.SetNumericValue(name, options.start_push);
  list.SetNumericValue("constr_mult_init_max", 0);  // multipliers start at 0, without a solve
  list.SetNumericValue("tol", std::max(options.tolerance, repair_policy::solver::kTolerance));
  list.SetNumericValue("compl_inf_tol", options.tolerance);
  list.SetNumericValue("constr_viol_tol", options.constraint_tolerance);
  list.SetIntegerValue("max_iter", options.max_iterations);
  if (options.still_change > 0) stop_where_still(list, options);
  list.SetNumericValue("bound_relax_factor", 0);
  list.SetIntegerValue("min_refinement_steps", 0);
}

NlpStatus status_of(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
    case Ipopt::Solved_To_Acceptable_Level:
    case Ipopt::Feasible_Point_Found:
      return NlpStatus::solved;
    case Ipopt::Infeasible_Problem_Detected:
      return NlpStatus::infeasible;
    case Ipopt::Maximum_Iterations_Exceeded:
      return NlpStatus::iteration_limit;
    default:
      return NlpStatus::failed;
  }
}

}  // namespace

double violation_at_start(const Nlp& nlp) {
  VectorXd g(nlp.constraint_lower.size());
  nlp.constraints(nlp.start, g);
  return std::max((nlp.constraint_lower - g).maxCoeff(), (g - nlp.constraint_upper).maxCoeff());
}

NlpSolution solve(const Nlp& nlp, const NlpOptions& options, const Progress& progress,
                  const std::string& stage) {
  Ipopt::SmartPtr<Adapter> adapter = new Adapter(nlp, options, progress, stage);
  Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
  set_options(*application->Options(), options);
  if (nlp.start_multipliers.size() > 0)
    start_with_multipliers(*application->Options(), options.start_push);
  const BandedKktScope banded(
      !options.mumps && !has_equalities(nlp),
      options.plain_kernels ? kernels::plain_kernels() : kernels::best_kernels());
  set_linear_solver(*application->Options(), banded.active());
  if (application->Initialize("") != Ipopt::Solve_Succeeded)
    fail(ErrorCode::solver, "Ipopt does not start: is its MUMPS linear solver installed?");
  const double begin = thread_seconds();
  const Ipopt::ApplicationReturnStatus status =
      application->OptimizeTNLP(Ipopt::SmartPtr<Ipopt::TNLP>(GetRawPtr(adapter)));
  if (adapter->thrown) std::rethrow_exception(adapter->thrown);
  if (status == Ipopt::User_Requested_Stop && !adapter->out_of_work) throw Interrupted();
  NlpSolution solution = adapter->solution;
  solution.out_of_work = adapter->out_of_work;
  solution.status = adapter->out_of_work ? NlpStatus::iteration_limit : status_of(status);
  solution.solver_seconds = thread_seconds() - begin - solution.function_seconds;
  if (solution.x.size() == 0) solution.x = nlp.start;
  return solution;
}

}  // namespace ayumi
