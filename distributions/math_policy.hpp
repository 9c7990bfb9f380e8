/// How Boost.Math evaluates, wherever this program asks it for a law or a special function.
///
/// In double: its default is long double, which has 80 bits on one processor and 128 on another, so
/// that the last bits of a draw or a bound would depend on the machine, at several times the cost, for
/// digits that the tests show are not needed. And without exceptions, since none may cross a thread: an
/// error becomes NaN or infinity.
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
