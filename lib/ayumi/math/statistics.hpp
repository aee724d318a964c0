#pragma once
// Exact statements about probabilities from counted events, and about unknown distributions from
// ranks. They assume nothing but independent runs. docs/certify.md derives them.

#include <cstddef>
#include <vector>

namespace ayumi {

/// The quantile of the standard normal distribution, for p in (0, 1).
double normal_quantile(double p);
/// The probability that a standard normal number is at most z.
double normal_probability(double z);

/// A closed interval.
struct RateInterval {
  double low = 0, high = 1;
};

/// The one-sided bounds of Clopper and Pearson (1934) for the probability of an event that happened
/// in k of n runs. The true value is at most the upper bound with a probability of at least
/// `confidence`, and it is at least the lower bound with the same probability. For n = 0, the
/// bounds are 1 and 0.
double upper_bound(long k, long n, double confidence);
double lower_bound(long k, long n, double confidence);
/// The interval of Clopper and Pearson, with (1 - confidence) / 2 on each side.
RateInterval clopper_pearson(long k, long n, double confidence);

/// McNemar's exact test of pairs: `only_first` pairs have the event in the first member alone,
/// `only_second` in the second alone. The result is the two-sided p-value of the hypothesis that
/// both members have the same probability; without such pairs it is 1.
double mcnemar(long only_first, long only_second);

/// The interval of p(first) - p(second) from `pairs` pairs: the difference of two intervals of
/// Clopper and Pearson, each with half of the error. It covers the true value with the probability
/// `confidence` or more.
RateInterval paired_difference(long only_first, long only_second, long pairs, double confidence);

/// The smallest rank r, counted from 1, for which the r-th smallest of n independent values is an
/// upper bound of the quantile q with this confidence, whatever their distribution; 0 if n is too
/// small.
long quantile_bound_rank(long n, double q, double confidence);

/// Spearman's rank correlation; equal values share the mean of their ranks. It is 0 if one of the
/// lists is constant or has fewer than two values.
double rank_correlation(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace ayumi
