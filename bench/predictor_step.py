#!/usr/bin/env python3
"""Time of one training step of GCN or POTR in Python's PyTorch, beside that of poise.

Networks, losses, optimisers and batch sizes are those of the presets `gcn` and `potr` on CMU, written
with PyTorch's own modules as their authors' papers describe them; the motions are noise. Run it
under the environment that poise gives its own programs:

  OMP_WAIT_POLICY=PASSIVE OMP_NUM_THREADS=1 bench/predictor_step.py gcn --steps 20

Poise's own: the seconds that predictor_learning prints, divided by its steps:

  OMP_NUM_THREADS=1 predictor_learning --data DIR/cmu --preset gcn --set trainer.steps=20 \\
      --set validation_share=0
"""

import argparse
import math
import time

import torch
from torch import nn

BATCH, FUTURE, FRAMES = 16, 25, 30_000


class GraphConvolution(nn.Module):
    def __init__(self, nodes, inputs, outputs, biased):
        super().__init__()
        most = 1 / math.sqrt(outputs)
        self.graph = nn.Parameter(torch.empty(nodes, nodes).uniform_(-most, most))
        self.weight = nn.Parameter(torch.empty(inputs, outputs).uniform_(-most, most))
        self.bias = nn.Parameter(torch.empty(outputs).uniform_(-most, most)) if biased else None

    def forward(self, x):
        y = torch.matmul(self.graph, torch.matmul(x, self.weight))
        return y if self.bias is None else y + self.bias


class Bent(nn.Module):
    """Graph convolution, batch norm over nodes and features, tanh, dropout."""

    def __init__(self, nodes, inputs, outputs, biased, dropout):
        super().__init__()
        self.graph = GraphConvolution(nodes, inputs, outputs, biased)
        self.norm, self.drop = nn.BatchNorm1d(nodes * outputs), nn.Dropout(dropout)

    def forward(self, x):
        y = self.graph(x)
        return self.drop(torch.tanh(self.norm(y.flatten(1)).view_as(y)))


class Gcn(nn.Module):
    COLUMNS, PAST, WIDTH, BLOCKS = 64, 10, 256, 12

    def __init__(self):
        super().__init__()
        frames = self.PAST + FUTURE
        k, i = torch.arange(frames)[:, None], torch.arange(frames)[None]
        self.dct = math.sqrt(2 / frames) * torch.cos(math.pi * (i + 0.5) * k / frames)
        self.dct[0] /= math.sqrt(2)
        self.first = Bent(self.COLUMNS, frames, self.WIDTH, True, 0.5)
        self.blocks = nn.ModuleList(
            nn.Sequential(*(Bent(self.COLUMNS, self.WIDTH, self.WIDTH, True, 0.5) for _ in range(2)))
            for _ in range(self.BLOCKS))
        self.last = GraphConvolution(self.COLUMNS, self.WIDTH, frames, True)

    def loss(self, rows):
        past = rows[:, :self.PAST]
        padded = torch.cat([past, past[:, -1:].expand(-1, FUTURE, -1)], 1)
        x = torch.matmul(self.dct, padded).transpose(1, 2)
        h = self.first(x)
        for block in self.blocks:
            h = h + block(h)
        answer = torch.matmul(self.dct.t(), (self.last(h) + x).transpose(1, 2))
        return (answer - rows).abs().sum(-1).mean()

    def optimizer(self):
        return torch.optim.Adam(self.parameters(), 5e-4)

    CLIP = 1.0


class EncoderLayer(nn.Module):
    def __init__(self, width, heads, hidden, dropout):
        super().__init__()
        self.attention = nn.MultiheadAttention(width, heads, dropout, batch_first=True)
        self.norm1, self.norm2 = nn.LayerNorm(width), nn.LayerNorm(width)
        self.up, self.down, self.drop = nn.Linear(width, hidden), nn.Linear(hidden, width), nn.Dropout(dropout)

    def forward(self, x, positions):
        n = self.norm1(x)
        placed = n + positions
        x = x + self.drop(self.attention(placed, placed, n)[0])
        return x + self.drop(self.down(self.drop(torch.relu(self.up(self.norm2(x))))))


class DecoderLayer(nn.Module):
    def __init__(self, width, heads, hidden, dropout):
        super().__init__()
        self.own = nn.MultiheadAttention(width, heads, dropout, batch_first=True)
        self.cross = nn.MultiheadAttention(width, heads, dropout, batch_first=True)
        self.norm1, self.norm2, self.norm3 = (nn.LayerNorm(width) for _ in range(3))
        self.up, self.down, self.drop = nn.Linear(width, hidden), nn.Linear(hidden, width), nn.Dropout(dropout)

    def forward(self, x, memory, positions):
        placed = self.norm1(x) + positions
        s = self.norm2(x + self.drop(self.own(placed, placed, placed)[0]))
        c = self.norm3(s + self.drop(self.cross(s, memory, memory)[0]))
        return c + self.drop(self.down(self.drop(torch.relu(self.up(c)))))


class Potr(nn.Module):
    """Every query is embedded by itself, as its authors do."""

    COLUMNS, PAST, NODE_WIDTH, WIDTH, HEADS, LAYERS, HIDDEN = 78, 50, 512, 128, 4, 4, 2048

    def __init__(self):
        super().__init__()
        nodes = self.COLUMNS // 3
        self.first = Bent(nodes, 3, self.NODE_WIDTH, False, 0.3)
        self.block = nn.Sequential(
            *(Bent(nodes, self.NODE_WIDTH, self.NODE_WIDTH, False, 0.3) for _ in range(2)))
        self.last = GraphConvolution(nodes, self.NODE_WIDTH, self.WIDTH, False)
        self.frame, self.drop = nn.Linear(nodes * self.WIDTH, self.WIDTH), nn.Dropout(0.3)
        sizes = (self.WIDTH, self.HEADS, self.HIDDEN, 0.3)
        self.encoder = nn.ModuleList(EncoderLayer(*sizes) for _ in range(self.LAYERS))
        self.decoder = nn.ModuleList(DecoderLayer(*sizes) for _ in range(self.LAYERS))
        self.pose = nn.Linear(self.WIDTH, self.COLUMNS)
        feature = torch.arange(self.WIDTH)
        angles = 10 * torch.arange(self.PAST)[:, None] / 500 ** (2 * (feature // 2) / self.WIDTH)[None]
        self.positions = torch.where(feature % 2 == 0, angles.sin(), angles.cos())

    def embed(self, rows):
        h = self.first(rows.reshape(-1, self.COLUMNS // 3, 3))
        h = h + self.block(h)
        return self.drop(self.frame(self.last(h).flatten(1))).view(*rows.shape[:2], -1)

    def loss(self, rows):
        query = rows[:, self.PAST - 1:self.PAST].expand(-1, FUTURE, -1)
        memory, x = self.embed(rows[:, :self.PAST - 1]), self.embed(query)
        for layer in self.encoder:
            memory = layer(memory, self.positions[:self.PAST - 1])
        total = 0
        for layer in self.decoder:
            x = layer(x, memory, self.positions[:FUTURE])
            total = total + (self.pose(x) + query - rows[:, self.PAST:]).abs().mean()
        return total / self.LAYERS

    def optimizer(self):
        return torch.optim.AdamW(self.parameters(), 1e-4, weight_decay=1e-5)

    CLIP = 0.1


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("network", choices=("gcn", "potr"))
    parser.add_argument("--steps", type=int, default=20)
    parser.add_argument("--threads", type=int, default=1)
    args = parser.parse_args()
    torch.set_num_threads(args.threads)
    torch.manual_seed(1)
    net = Gcn() if args.network == "gcn" else Potr()
    print(sum(parameter.numel() for parameter in net.parameters()), "parameters")
    optimizer = net.optimizer()
    motion = torch.randn(FRAMES, net.COLUMNS)
    window = torch.arange(net.PAST + FUTURE)

    def step():
        starts = torch.randint(FRAMES - len(window), (BATCH, 1))
        optimizer.zero_grad()
        loss = net.loss(motion[starts + window])
        loss.item()
        loss.backward()
        nn.utils.clip_grad_norm_(net.parameters(), net.CLIP)
        optimizer.step()

    step()
    began = time.perf_counter()
    for _ in range(args.steps):
        step()
    print(f"{(time.perf_counter() - began) / args.steps * 1000:.1f} ms a step")


if __name__ == "__main__":
    main()
