"""All campaigns by name: a new one is a module and a line here."""

from __future__ import annotations

from collections.abc import Mapping

from tools.campaigns.campaign import Campaign
from tools.campaigns.cams import cases as cams
from tools.campaigns.chains import cases as chains
from tools.campaigns.change_points import cases as change_points
from tools.campaigns.clearances import cases as clearances
from tools.campaigns.clusters import cases as clusters
from tools.campaigns.commands import cases as commands
from tools.campaigns.contacts import cases as contacts
from tools.campaigns.free_motions import cases as free_motions
from tools.campaigns.free_motions import examples as free_examples
from tools.campaigns.free_motions import references as free_references
from tools.campaigns.gaps import cases as gaps
from tools.campaigns.gears import cases as gears
from tools.campaigns.imports import cases as imports
from tools.campaigns.long_runs import cases as long_runs
from tools.campaigns.pages import cases as pages
from tools.campaigns.reactions import cases as reactions
from tools.campaigns.rotatability import cases as rotatability
from tools.campaigns.source_files import cases as source_files
from tools.campaigns.spheres import cases as spheres
from tools.campaigns.synthesis import paths as synthesised_paths
from tools.campaigns.synthesis import poses as five_poses

CAMPAIGNS: Mapping[str, Campaign] = {
    one.name: one
    for one in (
        chains.CAMPAIGN,
        change_points.CAMPAIGN,
        gaps.CAMPAIGN,
        rotatability.CAMPAIGN,
        spheres.CAMPAIGN,
        cams.CAMPAIGN,
        reactions.CAMPAIGN,
        commands.CAMPAIGN,
        clusters.CAMPAIGN,
        clearances.CAMPAIGN,
        free_motions.CAMPAIGN,
        free_examples.CAMPAIGN,
        free_references.CAMPAIGN,
        contacts.CAMPAIGN,
        long_runs.CAMPAIGN,
        pages.CAMPAIGN,
        source_files.CAMPAIGN,
        gears.CAMPAIGN,
        synthesised_paths.CAMPAIGN,
        five_poses.CAMPAIGN,
        imports.CAMPAIGN,
    )
}
