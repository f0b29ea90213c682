"""GCN and POTR as core/prediction has them (gcn_net.cc, potr_net.cc), many at once: every tensor begins
with a dimension for the models."""

import math

import torch
import torch.nn.functional as F

NORM_EPSILON = 1e-5

# Layers. `w` holds weights by name, each with the models' dimension first.

def drop(x, share, training):
    return F.dropout(x, share) if training and share > 0 else x


def linear(w, name, x):
    """(models, ..., inputs)"""
    bias, weight = w[name + ".bias"].unsqueeze(1), w[name + ".weight"].transpose(1, 2)
    return torch.baddbmm(bias, x.flatten(1, -2), weight).view(*x.shape[:-1], -1)


def layer_norm(w, name, x):
    scale, shift = (w[name + part][:, None, None] for part in (".weight", ".bias"))
    return F.layer_norm(x, x.shape[-1:], eps=NORM_EPSILON) * scale + shift


def bend(y, scale, shift, share):
    """Batch norm while training, tanh and dropout: (models, nodes, samples, features)."""
    variance, mean = torch.var_mean(y, 2, unbiased=False, keepdim=True)
    factor = scale * torch.rsqrt(variance + NORM_EPSILON)
    bent = F.dropout(torch.tanh(y * factor + (shift - mean * factor)), share)
    return bent, mean.detach(), variance.detach()


def attention(w, name, heads, share, training, query, key, value):
    weights, biases = w[name + ".in.weight"].chunk(3, 1), w[name + ".in.bias"].chunk(3, 1)

    def head(x, part):  # (models, batch, heads, frames, width / heads)
        y = linear({"in.weight": weights[part], "in.bias": biases[part]}, "in", x)
        return y.unflatten(-1, (heads, -1)).transpose(2, 3)

    q, k, v = head(query, 0), head(key, 1), head(value, 2)
    shares = torch.softmax(torch.matmul(q, k.transpose(3, 4)) / math.sqrt(q.shape[-1]), -1)
    said = torch.matmul(drop(shares, share, training), v).transpose(2, 3).flatten(3)
    return linear(w, name + ".out", said)


def perceptron(w, x, share, training):
    return drop(linear(w, "down", drop(torch.relu(linear(w, "up", x)), share, training)), share, training)


def encoder_layer(w, x, positions, heads, share, training):
    n = layer_norm(w, "norm1", x)
    placed = n + positions
    x = x + drop(attention(w, "attention", heads, share, training, placed, placed, n), share, training)
    return x + perceptron(w, layer_norm(w, "norm2", x), share, training)


def decoder_layer(w, x, memory, positions, heads, share, residual, training):
    placed = layer_norm(w, "norm1", x) + positions
    own = drop(attention(w, "self", heads, share, training, placed, placed, placed), share, training)
    s = layer_norm(w, "norm2", x + own)
    cross = drop(attention(w, "cross", heads, share, training, s, memory, memory), share, training)
    c = layer_norm(w, "norm3", s + cross)
    said = perceptron(w, c, share, training)
    return c + said if residual else said


FUSED = {}  # functions and what torch.compile made of them: the same in fewer kernels


def fused(function):
    """As training calls it."""
    return FUSED.get(function, function)


class Net:
    """What both families share: graph convolutions, of which training collects statistics."""

    def __init__(self, config):
        self.config = config
        self.past, self.future = config["past_frames"], config["future_frames"]
        self.share = config["dropout"]
        self.statistics = None  # of the last forward pass in training, by name

    def graph(self, w, name, x, training, bent=True):
        """(models, nodes, samples, features)"""
        models, nodes, samples, features = x.shape
        y = torch.bmm(x.reshape(models, nodes * samples, features), w[name + ".weight"])
        y = torch.bmm(w[name + ".graph"], y.view(models, nodes, -1)).view(models, nodes, samples, -1)
        bias = w.get(name + ".bias")
        bias = 0 if bias is None else bias[:, None, None]
        if not bent:
            return y + bias
        scale, shift, mean, variance = (w[f"{name}.norm.{part}"].view(models, nodes, 1, -1) for part in
                                        ("weight", "bias", "running_mean", "running_var"))
        if not training:
            return torch.tanh((y + bias - mean) * torch.rsqrt(variance + NORM_EPSILON) * scale + shift)
        y, mean, variance = fused(bend)(y, scale, shift, self.share)  # which takes any bias out again
        if not torch.is_tensor(bias):
            bias = torch.zeros_like(mean)
        self.statistics[name + ".norm.running_mean"] = (mean + bias.detach()).flatten(1)
        self.statistics[name + ".norm.running_var"] = (variance * (samples / (samples - 1))).flatten(1)
        return y


class Gcn(Net):
    def all_frames(self, w, rows, training):
        """Rows (models, windows, frames, columns), of which the past is looked at, to
        (models, columns, windows, frames)."""
        past = rows[:, :, :self.past].permute(0, 3, 1, 2)
        padded = torch.cat([past, past[..., -1:].expand(-1, -1, -1, self.future)], -1)
        dct = w["dct"][0]
        x = torch.matmul(padded, dct.t())
        h = self.graph(w, "layer0", x, training)
        for block in range(self.config["blocks"]):
            t = self.graph(w, f"layer{2 * block + 1}", h, training)
            h = h + self.graph(w, f"layer{2 * block + 2}", t, training)
        last = f"layer{2 * self.config['blocks'] + 1}"
        return torch.matmul(self.graph(w, last, h, training, bent=False) + x, dct)

    def losses(self, w, rows):
        self.statistics = {}
        answer = self.all_frames(w, rows, True)
        return (answer - rows.permute(0, 3, 1, 2)).abs().sum(1).mean((1, 2))

    def predict(self, w, rows):
        return self.all_frames(w, rows, False)[..., self.past:].permute(0, 2, 3, 1)


class Potr(Net):
    def __init__(self, config):
        super().__init__(config)
        width = config["width"]
        frame = torch.arange(max(self.past, self.future), dtype=torch.float64)
        feature = torch.arange(width)
        power = 2 * torch.div(feature, 2, rounding_mode="floor").double() / width
        angle = 10 * frame[:, None] / 500 ** power
        self.positions = torch.where(feature % 2 == 0, angle.sin(), angle.cos()).float()

    def embed(self, w, rows, training):
        models, windows, frames, columns = rows.shape
        x = rows.reshape(models, windows * frames, columns // 3, 3).transpose(1, 2)
        h = self.graph(w, "graph0", x, training)
        h = h + self.graph(w, "graph2", self.graph(w, "graph1", h, training), training)
        joints = self.graph(w, "graph3", h, training, bent=False).transpose(1, 2).flatten(2)
        return drop(linear(w, "frame", joints), self.share, training).view(models, windows, frames, -1)

    def by_layer(self, w, past, training):
        """Answers (models, windows, future, columns) of the decoder's layers."""
        self.positions = self.positions.to(past.device)
        embedded, last = self.embed(w, past, training), self.past - 1
        memory, query = embedded[:, :, :last].contiguous(), past[:, :, last:]
        heads, answers = self.config["heads"], []
        encode, decode = ((fused(f) if training else f) for f in (encoder_layer, decoder_layer))
        for i in range(self.config["layers"]):
            memory = encode(below(w, f"encoder{i}_"), memory, self.positions[:last], heads, self.share,
                            training)
        x = embedded[:, :, last:].expand(-1, -1, self.future, -1).contiguous()
        for i in range(self.config["layers"]):
            x = decode(below(w, f"decoder{i}_"), x, memory, self.positions[:self.future], heads, self.share,
                       self.config["residual"], training)
            answers.append(linear(w, "pose", x) + query)
        return answers

    def losses(self, w, rows):
        self.statistics = {}
        target = rows[:, :, self.past:]
        answers = self.by_layer(w, rows[:, :, :self.past], True)
        return sum((answer - target).abs().mean((1, 2, 3)) for answer in answers) / len(answers)

    def predict(self, w, rows):
        return self.by_layer(w, rows[:, :, :self.past], False)[-1]


def below(w, prefix):
    return {name[len(prefix):]: value for name, value in w.items() if name.startswith(prefix)}


NETS = {"gcn": Gcn, "potr": Potr}
