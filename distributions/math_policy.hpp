/// The policy for all laws and special functions of Boost.Math.
///
/// The policy evaluates in double. Boost's default, long double, costs several times as much and has 80 bits on one
/// processor and 128 on another, so that the last bits of a draw or bound would depend on the machine. Errors give NaN
/// or infinity instead of exceptions, which must not leave a thread.
#pragma once

#include <boost/math/policies/policy.hpp>

namespace wingspread {

namespace math_policy {
namespace bp = boost::math::policies;
using Policy =
    bp::policy<bp::domain_error<bp::ignore_error>, bp::pole_error<bp::ignore_error>,
               bp::overflow_error<bp::ignore_error>, bp::underflow_error<bp::ignore_error>,
               bp::denorm_error<bp::ignore_error>, bp::evaluation_error<bp::ignore_error>,
               bp::rounding_error<bp::ignore_error>,
               bp::indeterminate_result_error<bp::ignore_error>, bp::promote_double<false>>;
} // namespace math_policy

using MathPolicy = math_policy::Policy;

} // namespace wingspread
