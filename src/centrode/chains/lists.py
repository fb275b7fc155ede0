"""Lists of all chains, or all Assur groups, of a number of links, as results to be shown."""

from __future__ import annotations

from dataclasses import dataclass

from centrode.chains.assur_schemes import AssurScheme, assur_groups
from centrode.chains.kinematic_chains import KinematicChain, chains


@dataclass(frozen=True)
class ChainList:
    """All chains of so many links and so much mobility.

    Attributes
    ----------
    cut_links : also those whose parts a single link holds together
    """

    links: int
    mobility: int
    cut_links: bool
    chains: tuple[KinematicChain, ...]


@dataclass(frozen=True)
class AssurList:
    """All Assur groups of so many links."""

    links: int
    groups: tuple[AssurScheme, ...]


def chain_list(links: int, mobility: int = 1, *, cut_links: bool = False) -> ChainList:
    """All chains of so many links as a result; raises as `chains` does."""
    return ChainList(links, mobility, cut_links, chains(links, mobility, cut_links=cut_links))


def assur_list(links: int) -> AssurList:
    """All Assur groups of so many links as a result; raises as `assur_groups` does."""
    return AssurList(links, assur_groups(links))
