import pytest

from cogmap.evaluation.verdicts import betti_verdict, figure_verdict, worst


@pytest.mark.parametrize(
    ("answer", "figures", "judged"),
    [
        ("heading", {"heading_median_deg": 5.0}, "right"),
        ("heading", {"heading_median_deg": 5.1}, "WRONG"),
        ("heading", {"heading_median_deg": float("nan")}, "WRONG"),
        ("heading", {}, "WRONG"),
        ("place", {"position_median_m": 0.1, "heading_median_deg": 88.0}, "right"),
        ("place", {"position_median_m": 0.11}, "WRONG"),
    ],
)
def test_an_answer_stood_by_is_right_or_wrong(answer: str, figures: dict[str, float], judged: str) -> None:
    assert figure_verdict(answer, figures, trusted=True) == judged
    assert figure_verdict(answer, figures, trusted=False) == "unresolved"


@pytest.mark.parametrize(
    ("numbers", "resolved", "judged"),
    [
        ((1, 1, 0), (True, True, True), "right"),
        ((1, 1, 0), (True, False, True), "unresolved"),
        ((1, 3, 0), (True, False, True), "unresolved"),
        ((1, 3, 0), (True, True, True), "WRONG"),
        ((1, 3, 1), (True, False, True), "WRONG"),
    ],
)
def test_each_betti_number_is_judged_by_itself(
    numbers: tuple[int, ...], resolved: tuple[bool, ...], judged: str
) -> None:
    assert betti_verdict(numbers, resolved, (1, 1, 0)) == judged


def test_together_they_are_as_good_as_the_worst() -> None:
    assert worst(["right", "right"]) == "right"
    assert worst(["right", "unresolved"]) == "unresolved"
    assert worst(["unresolved", "WRONG", "right"]) == "WRONG"
