/// The policy for all laws and special functions of Boost.Math.
///
/// It evaluates in double. The default, long double, has 80 bits on one processor and 128 on another: the last bits of
/// a draw or bound would depend on the machine, at several times the cost. Errors give NaN or infinity instead of
/// exceptions, which must not cross threads.
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
