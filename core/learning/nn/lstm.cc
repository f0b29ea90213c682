#include "core/learning/nn/lstm.h"

#include <algorithm>
#include <vector>

#include "core/base/isa.h"
#include "core/learning/nn/kernel/lstm_kernel.h"

namespace poise::learning {
namespace {

using torch::autograd::AutogradContext;
using torch::autograd::variable_list;

// Sequences longest first and time step by time step: the rows of a step are the sequences that
// have it, and those of another step are the first of them.
struct Packing {
  std::vector<int64_t> rows;   // of each step
  std::vector<int64_t> first;  // row of each step

  explicit Packing(std::vector<int64_t> sizes) : rows(std::move(sizes)) {
    int64_t total = 0;
    for (const int64_t count : rows) {
      first.push_back(total);
      total += count;
    }
  }
  int64_t steps() const { return static_cast<int64_t>(rows.size()); }
  torch::Tensor Rows(const torch::Tensor& packed, int64_t step, int64_t count) const {
    return packed.narrow(0, first[step], count);
  }
};

// One visit of a step: which it is, which came before it in the direction of the LSTM, and how many
// of its rows had that one.
struct Visit {
  int64_t step, rows;
  int64_t previous, before;
};

std::vector<Visit> Order(const Packing& packing, bool reverse) {
  std::vector<Visit> visits;
  for (int64_t i = 0; i < packing.steps(); ++i) {
    const int64_t step = reverse ? packing.steps() - 1 - i : i;
    const int64_t previous = reverse ? step + 1 : step - 1;
    visits.push_back({step, packing.rows[step], previous,
                      i == 0 ? 0 : std::min(packing.rows[step], packing.rows[previous])});
  }
  return visits;
}

template <typename Real>
Real* RowPointer(const torch::Tensor& packed, const Packing& packing, int64_t step) {
  return packed.data_ptr<Real>() + packing.first[step] * packed.size(1);
}

// What one direction computed, all packed: (rows, 4 hidden), then (rows, hidden) each.
struct Trace {
  torch::Tensor gates, before, cell, squashed, output;
};

LstmStep StepOf(const Visit& visit, int64_t hidden) {
  return {static_cast<int>(visit.rows), static_cast<int>(visit.before), static_cast<int>(hidden)};
}

template <typename Real>
void ForwardStep(Trace& trace, const Packing& packing, const Visit& visit) {
  using Kernel = void(const LstmForwardArguments<Real>&);
  static Kernel* const kernel =
      base::SelectKernel<Kernel>(isa_v2::LstmForward, isa_v3::LstmForward, isa_v4::LstmForward);
  const auto at = [&](const torch::Tensor& packed, int64_t step) {
    return RowPointer<Real>(packed, packing, step);
  };
  kernel({.step = StepOf(visit, trace.cell.size(1)),
          .gates = at(trace.gates, visit.step),
          .cell_before = visit.before > 0 ? at(trace.cell, visit.previous) : nullptr,
          .cell = at(trace.cell, visit.step),
          .squashed = at(trace.squashed, visit.step),
          .output = at(trace.output, visit.step)});
}

template <typename Real>
void BackwardStep(const Trace& trace, const Packing& packing, const Visit& visit,
                  const torch::Tensor& output_grad, torch::Tensor& cell_grad,
                  torch::Tensor& gates_grad) {
  using Kernel = void(const LstmBackwardArguments<Real>&);
  static Kernel* const kernel =
      base::SelectKernel<Kernel>(isa_v2::LstmBackward, isa_v3::LstmBackward, isa_v4::LstmBackward);
  const auto at = [&](const torch::Tensor& packed, int64_t step) {
    return RowPointer<Real>(packed, packing, step);
  };
  kernel({.step = StepOf(visit, trace.cell.size(1)),
          .gates = at(trace.gates, visit.step),
          .cell_before = visit.before > 0 ? at(trace.cell, visit.previous) : nullptr,
          .squashed = at(trace.squashed, visit.step),
          .output_grad = output_grad.data_ptr<Real>(),
          .cell_grad = cell_grad.data_ptr<Real>(),
          .gates_grad = at(gates_grad, visit.step)});
}

// inputs (rows, inputs); weights as in LibTorch: (4 hidden, inputs), (4 hidden, hidden), (4 hidden)
// twice.
class Direction : public torch::autograd::Function<Direction> {
 public:
  static torch::Tensor forward(AutogradContext* context, const torch::Tensor& inputs,
                               const torch::Tensor& input_weights,
                               const torch::Tensor& state_weights, const torch::Tensor& input_bias,
                               const torch::Tensor& state_bias, std::vector<int64_t> rows,
                               bool reverse) {
    const Packing packing(rows);
    const int64_t count = inputs.size(0), hidden = state_weights.size(1);
    const torch::Tensor turned = state_weights.t();
    Trace trace;
    trace.gates = torch::addmm(input_bias + state_bias, inputs, input_weights.t());
    trace.before = torch::zeros({count, hidden}, inputs.options());
    trace.cell = torch::empty({count, hidden}, inputs.options());
    trace.squashed = torch::empty_like(trace.cell);
    trace.output = torch::empty_like(trace.cell);
    for (const Visit& visit : Order(packing, reverse)) {
      if (visit.before > 0) {
        torch::Tensor state = packing.Rows(trace.before, visit.step, visit.before);
        state.copy_(packing.Rows(trace.output, visit.previous, visit.before));
        packing.Rows(trace.gates, visit.step, visit.before).addmm_(state, turned);
      }
      AT_DISPATCH_FLOATING_TYPES(inputs.scalar_type(), "LSTM",
                                 [&] { ForwardStep<scalar_t>(trace, packing, visit); });
    }
    context->save_for_backward({inputs, input_weights, state_weights});
    // Of no caller's, so that nobody else can change them.
    context->saved_data["trace"] =
        std::vector<torch::Tensor>{trace.gates, trace.before, trace.cell, trace.squashed};
    context->saved_data["rows"] = rows;
    context->saved_data["reverse"] = reverse;
    return trace.output;
  }

  static variable_list backward(AutogradContext* context, variable_list grads) {
    const auto saved = context->get_saved_variables();
    const torch::Tensor &inputs = saved[0], &input_weights = saved[1], &state_weights = saved[2];
    const std::vector<torch::Tensor> kept = context->saved_data["trace"].toTensorVector();
    const Trace trace{kept[0], kept[1], kept[2], kept[3], {}};
    const Packing packing(context->saved_data["rows"].toIntVector());
    const int64_t hidden = state_weights.size(1);
    const torch::Tensor later = grads[0].contiguous();

    torch::Tensor gates_grad = torch::empty_like(trace.gates);
    // Of the sequences, longest first; those that a step has not yet reached have none.
    const int64_t sequences = packing.rows.front();
    torch::Tensor output_grad = torch::empty({sequences, hidden}, inputs.options());
    torch::Tensor state_grad = torch::zeros({sequences, hidden}, inputs.options());
    torch::Tensor cell_grad = torch::zeros({sequences, hidden}, inputs.options());
    std::vector<Visit> visits = Order(packing, context->saved_data["reverse"].toBool());
    std::reverse(visits.begin(), visits.end());
    for (const Visit& visit : visits) {
      torch::Tensor here = output_grad.narrow(0, 0, visit.rows);
      torch::add_out(here, packing.Rows(later, visit.step, visit.rows),
                     state_grad.narrow(0, 0, visit.rows));
      AT_DISPATCH_FLOATING_TYPES(inputs.scalar_type(), "LSTM", [&] {
        BackwardStep<scalar_t>(trace, packing, visit, output_grad, cell_grad, gates_grad);
      });
      // Sequences that began here hand nothing on.
      if (visit.before < visit.rows) {
        state_grad.narrow(0, visit.before, visit.rows - visit.before).zero_();
        cell_grad.narrow(0, visit.before, visit.rows - visit.before).zero_();
      }
      if (visit.before == 0) continue;
      torch::Tensor state = state_grad.narrow(0, 0, visit.before);
      torch::mm_out(state, packing.Rows(gates_grad, visit.step, visit.before), state_weights);
    }

    variable_list result(7);
    if (context->needs_input_grad(0)) result[0] = gates_grad.mm(input_weights);
    if (context->needs_input_grad(1)) result[1] = gates_grad.t().mm(inputs);
    if (context->needs_input_grad(2)) result[2] = gates_grad.t().mm(trace.before);
    if (context->needs_input_grad(3)) result[3] = gates_grad.sum(0);
    if (context->needs_input_grad(4)) {
      result[4] = result[3].defined() ? result[3] : gates_grad.sum(0);
    }
    return result;
  }
};

}  // namespace

torch::Tensor RunLstm(const torch::nn::LSTM& lstm, const torch::Tensor& inputs,
                      const torch::Tensor& lengths) {
  const int64_t batch = inputs.size(0), frames = inputs.size(1);
  const torch::Tensor order = lengths.argsort(/*dim=*/0, /*descending=*/true);
  const torch::Tensor sorted = lengths.index_select(0, order).contiguous();
  const int64_t* length = sorted.data_ptr<int64_t>();
  const int64_t* sequence = order.data_ptr<int64_t>();
  std::vector<int64_t> rows, where;
  int64_t count = batch;
  for (int64_t step = 0; step < length[0]; ++step) {
    while (length[count - 1] <= step) --count;
    rows.push_back(count);
    for (int64_t row = 0; row < count; ++row) where.push_back(sequence[row] * frames + step);
  }
  const torch::Tensor indices = torch::tensor(where, torch::kInt64);
  const torch::Tensor packed = inputs.flatten(0, 1).index_select(0, indices);
  const auto weights = lstm->all_weights();
  variable_list outputs;
  for (size_t direction = 0; direction * 4 < weights.size(); ++direction) {
    const auto* w = &weights[direction * 4];
    outputs.push_back(Direction::apply(packed, w[0], w[1], w[2], w[3], rows, direction == 1));
  }
  const torch::Tensor together = outputs.size() == 1 ? outputs[0] : torch::cat(outputs, 1);
  return torch::zeros({batch * frames, together.size(1)}, inputs.options())
      .index_copy(0, indices, together)
      .view({batch, frames, together.size(1)});
}

torch::Tensor RunLstm(const torch::nn::LSTM& lstm, const torch::Tensor& inputs) {
  return RunLstm(lstm, inputs, torch::full({inputs.size(0)}, inputs.size(1), torch::kInt64));
}

}  // namespace poise::learning
