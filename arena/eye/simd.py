"""SIMD in whole numbers: numba leaves LLVM's vectoriser of straight-line code off, so it is spelt out.

Colours are fixed-point numbers of two bytes, which are the same on every processor and fill a register twice
as well as float32. A product of two keeps its upper half and cuts the rest.
"""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

_BYTE, _SHORT, _WORD, _LONG = (ir.IntType(bits) for bits in (8, 16, 32, 64))


def _lanes(kind: Any, *values: int) -> Any:
    return ir.Constant(ir.VectorType(kind, len(values)), list(values))


def _splat(builder: Any, value: Any, count: int) -> Any:
    nothing = ir.Constant(ir.VectorType(value.type, count), ir.Undefined)
    # What the other lanes hold does not matter: the shuffle takes lane 0 for all.
    one = builder.insert_element(nothing, value, _WORD(0))
    return builder.shuffle_vector(one, nothing, _lanes(_WORD, *[0] * count))


def _call(builder: Any, name: str, a: Any, b: Any, *more: Any) -> Any:
    made = ir.FunctionType(a.type, [a.type, b.type, *(one.type for one in more)])
    full = f"llvm.{name}.v{a.type.count}i{a.type.element.width}"
    return builder.call(cgutils.get_or_insert_function(builder.module, made, full), [a, b, *more])


def _scaled(builder: Any, values: Any, shares: Any) -> Any:
    """Multiply numbers of two bytes by shares of 65536."""
    # Spelt out as product and shift, LLVM finds the one instruction for it in half of the places only.
    return _call(builder, "umul.fix", values, shares, _WORD(16))


def _at(context: Any, builder: Any, array: tuple[Any, Any], index: Any, vector: Any) -> Any:
    """Point to a vector that begins with an item of an array (its type, itself) of one dimension."""
    data = context.make_array(array[0])(context, builder, array[1]).data
    return builder.bitcast(builder.gep(data, [index]), vector.as_pointer())


def _mixing(added: bool, sentence: str) -> Any:  # noqa: FBT001
    """Make an intrinsic that mixes texels."""

    def mix(_typing: Any, texels: Any, starts: Any, shares: Any, strip: Any, at: Any) -> Any:
        def codegen(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            texels, starts, shares, strip, at = arguments
            bytes_, shorts = (ir.VectorType(kind, 32) for kind in (_BYTE, _SHORT))
            where = _at(context, builder, (signature.args[3], strip), at, shorts)
            total = builder.load(where, align=2) if added else _lanes(_SHORT, *[0] * 32)
            for n in range(signature.args[1].count):
                place = builder.extract_value(starts, n)
                place = _at(context, builder, (signature.args[0], texels), place, bytes_)
                read = builder.shl(
                    builder.zext(builder.load(place, align=1), shorts), _lanes(_SHORT, *[8] * 32)
                )
                part = _scaled(builder, read, _splat(builder, builder.extract_value(shares, n), 32))
                total = builder.add(total, part)
            builder.store(total, where, align=2)
            return context.get_dummy_value()

        return types.none(texels, starts, shares, strip, types.int64), codegen

    mix.__doc__ = sentence
    return intrinsic(mix)


set_texels = _mixing(
    added=False,
    sentence="Set strip[at : at + 32] to a sum of texel bytes, each from its start, by shares of 65536.",
)
add_texels = _mixing(added=True, sentence="Add what `set_texels` would set.")


def _add_to(context: Any, builder: Any, column: tuple[Any, Any], row: Any, parts: Any) -> None:
    """Add the sum of a few fours of numbers to a row."""
    while parts.type.count > 4:
        half = parts.type.count // 2
        halves = (_lanes(_WORD, *range(first, first + half)) for first in (0, half))
        parts = builder.add(*(builder.shuffle_vector(parts, parts, lanes) for lanes in halves))
    where = _at(context, builder, column, builder.shl(row, _LONG(2)), parts.type)
    builder.store(builder.add(builder.load(where, align=2), parts), where, align=2)


def _between(builder: Any, rest: Any, _more: Any) -> Any:
    """Weights of two texels for a point that lies `rest` beyond the first."""
    # All bits turned over is 65535 less the number.
    return builder.xor(rest, _lanes(_SHORT, *[65535] * 4, *[0] * 4))


def _over(builder: Any, rest: Any, more: Any) -> Any:
    """Weights of four texels for a stretch of one and `more` that begins `rest` beyond the first."""

    def on(texel: int) -> Any:
        return _lanes(_SHORT, *(65535 * (k // 4 == texel) for k in range(16)))

    # The first is covered to its end. The second is covered as far as goes, what goes beyond is of the third,
    # and the fourth has none: sums and differences stop at the largest and smallest number.
    begun = _call(builder, "uadd.sat", builder.xor(rest, on(0)), builder.and_(more, on(1)))
    beyond = builder.or_(builder.and_(builder.not_(more), on(2)), on(3))
    return _call(builder, "usub.sat", begun, beyond)


def _rows(weigh: Any, lanes: int, sentence: str) -> Any:
    """Make an intrinsic that adds consecutive rows, each a weighted sum of so many numbers of texels."""

    def add_rows(
        _typing: Any, strip: Any, at: Any, step: Any, more: Any, share: Any, column: Any, rows: Any
    ) -> Any:
        def codegen(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            strip, at, step, more, share, column, rows = arguments
            lowest, count = (builder.extract_value(rows, n) for n in range(2))

            def part(position: Any) -> Any:
                return _splat(builder, builder.trunc(builder.lshr(position, _LONG(16)), _SHORT), lanes)

            more, stride = _splat(builder, more, lanes), part(step)
            if signature.args[4] is not types.none:
                share = _splat(builder, share, lanes)
            # Carried along as a register: to make it anew of `at` takes longer than all the rest of a row.
            rest = cgutils.alloca_once_value(builder, part(at))
            with cgutils.for_range(builder, count) as loop:
                place = builder.add(at, builder.mul(loop.index, step))
                texel = builder.shl(builder.ashr(place, _LONG(32)), _LONG(2))
                now = builder.load(rest)
                builder.store(builder.add(now, stride), rest)
                weights = weigh(builder, now, more)
                if signature.args[4] is not types.none:
                    weights = _scaled(builder, weights, share)
                kind = ir.VectorType(_SHORT, lanes)
                read = builder.load(_at(context, builder, (signature.args[0], strip), texel, kind), align=2)
                row = builder.sub(lowest, loop.index)
                _add_to(context, builder, (signature.args[5], column), row, _scaled(builder, read, weights))
            return context.get_dummy_value()

        return types.none(strip, types.int64, types.int64, types.uint16, share, column, rows), codegen

    add_rows.__doc__ = sentence
    return intrinsic(add_rows)


add_between = _rows(_between, 8, "Add points between two texels to rows; see `add_over`.")
add_over = _rows(
    _over,
    16,
    """Add stretches of one texel and `more` (of 65536) to rows = (lowest, count), from there upwards.

    A texel of the strip and a row of the column are four numbers each. The lowest row's stretch begins at
    strip `at` and each further one a `step` later, both in 2^-32 texels and multiples of 2^-16. What is added
    is the sum over a stretch, or a `share` of it (of 65536) unless that is None.
    """,
)


@intrinsic
def add_colour(_typing: Any, red: Any, green: Any, blue: Any, share: Any, column: Any, row: Any) -> Any:
    """Add a share (of 32768) of a colour to a row; the colour counts 256 a grey level."""

    def codegen(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        *channels, share, column, row = arguments
        colour = _lanes(_SHORT, *[0] * 4)
        for lane, channel in enumerate(channels):
            colour = builder.insert_element(colour, channel, _WORD(lane))
        parts = _scaled(builder, colour, _splat(builder, share, 4))
        _add_to(context, builder, (signature.args[4], column), row, parts)
        return context.get_dummy_value()

    short = types.uint16
    return types.none(*[short] * 4, column, types.int64), codegen


@intrinsic
def write_four(_typing: Any, columns: Any, row: Any, image: Any, column: Any) -> Any:
    """Write four rows of four columns into an image of three bytes a pixel, from `row` and `column` on.

    `columns` are four bytes a row, the last of them spare.
    """

    def codegen(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kind, _, image_kind, _ = signature.args
        columns, row, image, column = arguments
        four, sixteen = ir.VectorType(_WORD, 4), ir.VectorType(_BYTE, 16)
        columns = context.make_array(kind)(context, builder, columns)
        image = context.make_array(image_kind)(context, builder, image)
        length = builder.extract_value(columns.strides, 0)
        base = builder.gep(builder.bitcast(columns.data, _BYTE.as_pointer()), [builder.shl(row, _LONG(2))])
        loaded = []
        for _ in range(4):
            loaded.append(builder.load(builder.bitcast(base, four.as_pointer()), align=4))
            base = builder.gep(base, [length])

        def mixed(a: Any, b: Any, *lanes: int) -> Any:
            return builder.shuffle_vector(a, b, _lanes(_WORD, *lanes))

        low = [mixed(*loaded[k : k + 2], 0, 4, 1, 5) for k in (0, 2)]
        high = [mixed(*loaded[k : k + 2], 2, 6, 3, 7) for k in (0, 2)]
        rows = [mixed(*half, *lanes) for half in (low, high) for lanes in ((0, 1, 4, 5), (2, 3, 6, 7))]
        pitch = builder.extract_value(image.strides, 0)
        to = builder.add(builder.mul(row, pitch), builder.mul(column, _LONG(3)))
        to = builder.gep(builder.bitcast(image.data, _BYTE.as_pointer()), [to])
        for pixels in rows:
            dense = builder.bitcast(pixels, sixteen)
            dense = mixed(dense, dense, *(k for k in range(16) if k % 4 < 3))
            builder.store(dense, builder.bitcast(to, dense.type.as_pointer()), align=1)
            to = builder.gep(to, [pitch])
        return context.get_dummy_value()

    return types.none(columns, types.int64, image, types.int64), codegen
