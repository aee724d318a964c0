#pragma once
// One visitor for std::visit, made of a function for each alternative.

namespace ayumi {

template <typename... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <typename... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace ayumi
