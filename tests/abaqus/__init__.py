"""Tests of the ABAQUS/CAE plug-in on a stand-in for ABAQUS; nothing here runs ABAQUS."""
