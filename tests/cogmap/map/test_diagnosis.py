from cogmap.map.diagnosis import Diagnosis, Verdict, topology_verdict
from tests.cogmap.shape.numbers import betti_of


def test_trusted_is_without_a_reason() -> None:
    assert Verdict().trusted
    assert not Verdict("it is dark").trusted


def test_topology_is_trusted_where_all_numbers_are_resolved() -> None:
    sure, unsure = betti_of((1, 1, 0)), betti_of((1, 2, 0), ("", "it is short", "it is close"))
    assert topology_verdict({}).trusted
    assert topology_verdict({"seen": sure, "fused": sure}).trusted
    assert topology_verdict({"seen": sure, "seen_and_smelt": unsure}).reason == (
        "H1 of seen and smelt is unresolved: it is short; H2 of seen and smelt is unresolved: it is close"
    )


def test_without_any_loop_it_is_trusted_only_where_headings_close() -> None:
    ball, ring = betti_of((1, 0, 0)), betti_of((1, 1, 0))
    assert topology_verdict({"seen": ball}).trusted
    assert topology_verdict({"seen": ring}, turned=False).trusted
    assert "no loop is counted in what is seen and smelt, and none of headings closes" in (
        topology_verdict({"seen": ring, "seen_and_smelt": ball}, turned=False).reason
    )


def test_it_reads_as_four_lines() -> None:
    told = Diagnosis(Verdict(), Verdict("two places smell alike"), Verdict(), Verdict())
    assert str(told).splitlines() == [
        "heading: trusted",
        "place: two places smell alike",
        "metric map: trusted",
        "topology: trusted",
    ]
